// What the cameras saw along a journey: DescribeRoute of the server, drawn.
import { useEffect, useRef } from 'preact/hooks';
import { colour, themed } from './parts.jsx';

const bytesOf = (text) => Uint8Array.from(atob(text ?? ''), (c) => c.charCodeAt(0));
const words = { CAMERA_DIRECTION_ACROSS: 'across', CAMERA_DIRECTION_ALONG: 'along', CAMERA_DIRECTION_MIXED: 'mixed' };
export const sideWord = (side) => (side === 'SIDE_RIGHT' ? 'right' : 'left');
export const directions = (route) =>
  (route?.sides ?? []).map((s) => `${sideWord(s.side)} ${words[s.direction] ?? 'unknown'}`).join(', ') || undefined;

// {columns, rows, each, sides: {SIDE_LEFT: {flow, counts, nearness}}}
export function readRoute(route) {
  const sides = {};
  for (const s of route?.sides ?? []) sides[s.side] = { flow: s.flowPx ?? [], counts: bytesOf(s.counts), nearness: bytesOf(s.nearness) };
  return { columns: route?.gridColumns ?? 0, rows: route?.gridRows ?? 0, each: Number(route?.stepsEach ?? 1), sides };
}

// Flow vectors of each cell of column `at`: code = 30 sqrt(vectors / n), n the geometric mean of their number and 180.
export function vectorsAt(route, side, at = 0) {
  const cells = route.columns * route.rows;
  const codes = [...(route.sides[side]?.counts.subarray(at * cells, (at + 1) * cells) ?? [])];
  const sum = codes.reduce((total, code) => total + (code / 30) ** 2, 0);
  return codes.map((code) => 180 * sum * (code / 30) ** 2);
}

// A lane a side: x the step, y the place in the image, dark where many flow vectors are.
export function Profiles({ route, steps }) {
  const canvas = useRef();
  const theme = themed();
  const sides = Object.entries(route.sides);
  useEffect(() => {
    const draw = () => {
      const c = canvas.current, scale = devicePixelRatio || 1, w = c.clientWidth, h = c.clientHeight;
      c.width = w * scale; c.height = h * scale;
      const g = c.getContext('2d');
      g.scale(scale, scale);
      g.font = '12px system-ui';
      const gap = 6, lane = (h - 22) / sides.length;
      // Whole pixels: cells that overlap would show as a grid of dark lines.
      const px = (step) => Math.round((w * step) / Math.max(1, steps));
      const py = (n, x) => Math.round(n * lane + (x * (lane - gap)) / route.columns);
      sides.forEach(([side, seen], n) => {
        const columns = seen.flow.length;
        const most = seen.counts.reduce((a, b) => Math.max(a, b), 1);
        g.fillStyle = colour('accent');
        for (let i = 0; i < columns; ++i) {
          for (let x = 0; x < route.columns; ++x) {
            let code = 0;
            for (let y = 0; y < route.rows; ++y) code = Math.max(code, seen.counts[(i * route.rows + y) * route.columns + x]);
            if (!code) continue;
            g.globalAlpha = code / most;
            g.fillRect(px(i * route.each), py(n, x), px((i + 1) * route.each) - px(i * route.each), py(n, x + 1) - py(n, x));
          }
        }
        g.globalAlpha = 1;
        g.fillStyle = colour('card');
        g.fillRect(4, n * lane + 3, 66, 16);
        g.fillStyle = colour('text');
        g.fillText(sideWord(side) + ' side', 8, n * lane + 15);
      });
      g.fillText('0', 2, h - 6);
      const last = 'step ' + steps;
      g.fillText(last, w - g.measureText(last).width - 2, h - 6);
    };
    draw();
    const resize = new ResizeObserver(draw);
    resize.observe(canvas.current);
    return () => resize.disconnect();
  }, [route, steps, theme]);
  return (
    <figure class="chart">
      <figcaption>Flow profiles along the route <span class="dim">(x: step from home; y: place along the image, its left on top; strong colour: many flow vectors)</span></figcaption>
      <canvas class="profiles" ref={canvas} role="img" aria-label={`Flow profiles of ${sides.length} cameras over ${steps} steps`} />
    </figure>
  );
}

// One view of one step: the mean flow of each cell, the landmarks, and below them the histogram of the vectors along x with
// the valley that divides two landmarks.
export function View({ title, seen, camera, partners, route, side }) {
  const w = camera?.width || 640, h = camera?.height || 480, low = h * 0.3;
  const vectors = vectorsAt(route, side), cw = w / (route.columns || 1), ch = h / (route.rows || 1);
  const flow = route.sides[side]?.flow[0] ?? 0, nearness = route.sides[side]?.nearness ?? [];
  const bins = Array.from({ length: route.columns }, (_, x) => vectors.reduce((sum, v, i) => sum + (i % route.columns === x ? v : 0), 0));
  const most = Math.max(...bins, 1), few = w / 160;
  const [from, to] = seen.map((f) => Math.min(route.columns - 1, Math.floor(f.x / cw))).sort((a, b) => a - b);
  let valley = -1;
  for (let x = from + 1; x < to; ++x) if (valley < 0 || bins[x] < bins[valley]) valley = x;
  const total = Math.round(bins.reduce((a, b) => a + b, 0));
  return (
    <figure class="chart"><figcaption>{title}</figcaption>
      <svg class="view" viewBox={`0 0 ${w} ${h + low * 1.1}`} role="img" aria-label={`${title}: ${seen.length} landmarks, about ${total} flow vectors`}>
        <rect width={w} height={h} class="frame" />
        <g class="flow">{vectors.map((v, i) => {
          if (v < 0.5) return null;
          const x = (i % route.columns + 0.5) * cw, y = (Math.floor(i / route.columns) + 0.5) * ch;
          const half = (flow * 2 ** (((nearness[i] || 8) - 8) / 4)) / 2;
          return <g key={i}><line x1={x - half} y1={y} x2={x + half} y2={y} stroke-width={Math.min(ch / 2, few * Math.sqrt(v))} /><circle cx={x + half} cy={y} r={few} /></g>;
        })}</g>
        {seen.map((f) => (
          <g key={f.id} class={partners.has(f.id) ? 'paired' : 'single'}>
            <circle cx={f.x} cy={f.y} r={(Math.sqrt(f.count) * w) / 240} />
            <text x={Math.min(f.x + (Math.sqrt(f.count) * w) / 240 + w / 100, w * 0.92)} y={Math.max(f.y, h / 20)} font-size={w / 28}>{f.id}</text>
          </g>))}
        <g class="histogram">{bins.map((v, x) => <rect key={x} x={x * cw + cw * 0.08} width={cw * 0.84} y={h + low * 1.1 - (low * v) / most} height={(low * v) / most} />)}
          {valley >= 0 && <line x1={(valley + 0.5) * cw} x2={(valley + 0.5) * cw} y1={h * 0.02} y2={h + low * 1.1} stroke-width={few} />}</g>
      </svg>
      <p class="dim">{seen.length === 0 ? 'No landmark at this step. ' : ''}{total > 0 ? `About ${total} flow vectors, median flow ${Math.abs(flow).toFixed(1)} px.` : 'No flow profile at this step.'}</p>
    </figure>
  );
}
