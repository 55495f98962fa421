// Parts that the pages share.
import { useEffect, useRef, useState } from 'preact/hooks';
import uPlot from 'uplot';

export const short = (name = '') => name.replace(/^robots\//, '').replace('/journeys/', ' / ');
export const link = (page, name) => `#/${page}/${name}`;
export const percent = (x, digits = 0) => (x === undefined ? '–' : (100 * x).toFixed(digits) + ' %');
export const number = (x) => Number(x ?? 0).toLocaleString('en');
export function bytes(x) {
  const units = ['B', 'KiB', 'MiB', 'GiB', 'TiB'];
  let i = 0;
  for (; x >= 1024 && i < 4; ++i) x /= 1024;
  return `${i ? x.toFixed(1) : x} ${units[i]}`;
}
export function ago(time) {
  if (!time) return '–';
  const s = Math.max(0, (Date.now() - Date.parse(time)) / 1000);
  if (s < 60) return `${Math.floor(s)} s ago`;
  if (s < 3600) return `${Math.floor(s / 60)} min ago`;
  if (s < 86400) return `${Math.floor(s / 3600)} h ago`;
  return `${Math.floor(s / 86400)} d ago`;
}
// Draws the component again every five seconds, so that its times stay true while nothing happens.
export function useClock() {
  const [, tick] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => tick((n) => n + 1), 5000);
    return () => clearInterval(timer);
  }, []);
}

// LOST and the like: one word and a shape, so that colour is not needed.
export function stateOf(robot) {
  if (robot.activity === 'ACTIVITY_RECORDING') return { rank: 2, tone: 'info', mark: '●', word: 'Recording' };
  if (robot.activity !== 'ACTIVITY_LOCALIZING') return { rank: 4, tone: 'off', mark: '○', word: 'Offline' };
  if (robot.lostSince) return { rank: 0, tone: 'bad', mark: '▲', word: 'Lost' };
  const outcome = robot.answer?.outcome;
  if (outcome === 'OUTCOME_MATCH') return { rank: 3, tone: 'good', mark: '✓', word: 'On route' };
  return { rank: 1, tone: 'warn', mark: '◆', word: outcome ? 'Ambiguous' : 'Starting' };
}
export const Badge = ({ state }) => (
  <span class={'badge ' + state.tone}><span aria-hidden="true">{state.mark}</span> {state.word}</span>
);
export const Progress = ({ value, label }) => (value === undefined ? <span class="dim">–</span> : (
  <span class="progress">
    <progress max="1" value={value} aria-label={label}>{percent(value)}</progress> <span class="num">{percent(value)}</span>
  </span>
));
export const Empty = ({ title, command, children }) => (
  <div class="empty">
    <h2>{title}</h2>
    {children && <p>{children}</p>}
    {command && <pre tabindex="0"><code>{command}</code></pre>}
  </div>
);
export const Loading = ({ error, what }) => (error
  ? <p class="error" role="alert">{what} cannot be shown: {error.message}</p>
  : <p class="dim" role="status">Loading {what.toLowerCase()} …</p>);
export const Tile = ({ label, value, tone }) => (
  <div class={'tile ' + (tone ?? '')}><div class="value">{value}</div><div class="label">{label}</div></div>
);
export const Facts = ({ facts }) => (
  <dl class="facts">{facts.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value ?? '–'}</dd></div>)}</dl>
);

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
export const themed = () => document.documentElement.dataset.theme + matchMedia('(prefers-color-scheme: dark)').matches;

// A time axis spans at least half a minute, so that its ticks are whole seconds.
const atLeast30s = (_, min, max) => (min == null ? [min, max] : [Math.min(min, max - 30), max]);
const clock = (_, times) => times.map((t) => (t % 1 ? '' : new Date(t * 1000).toLocaleTimeString('en-GB')));
// A uPlot chart; `series` is [{label, colour, values, bars, dash, scale}], all over `x`.
export function Chart({ title, x, series, xLabel, xRange, yLabel, range, height = 200, time = false, whole = false, describe }) {
  const box = useRef();
  const plot = useRef();
  const made = useRef('');
  useEffect(() => {
    const key = [title, xRange, series.map((s) => s.label), themed(), height].join();
    // uPlot stretches a single instant over a day.
    const alone = time && x.length === 1;
    const data = [alone ? [x[0] - 30, ...x] : x, ...series.map((s) => (alone ? [null, ...s.values] : s.values))];
    if (plot.current && made.current === key) {
      plot.current.setData(data);
      return;
    }
    plot.current?.destroy();
    made.current = key;
    const axis = (label) => ({
      label, stroke: colour('text'), grid: { stroke: colour('line'), width: 1 }, ticks: { stroke: colour('line') },
      font: '12px system-ui', labelFont: '12px system-ui', labelSize: 18, size: 54,
    });
    plot.current = new uPlot({
      width: box.current.clientWidth || 300, height,
      scales: { x: { time, range: time ? atLeast30s : xRange }, y: { range: range ?? undefined } },
      axes: [{ ...axis(xLabel), size: 30, ...(time && { values: clock, space: 70 }) }, { ...axis(yLabel), ...(whole && { incrs: [1, 2, 5, 10, 20, 50, 100] }) }],
      legend: { show: series.length > 1 }, cursor: { y: false },
      series: [{ label: xLabel, value: (_, v) => (v == null ? '–' : time ? new Date(v * 1000).toLocaleTimeString('en-GB') : +v.toPrecision(6)) }, ...series.map((s) => ({
        label: s.label, stroke: colour(s.colour), width: s.bars ? 0 : 2, dash: s.dash, points: { show: false }, pxAlign: s.bars ? 1 : 0,
        fill: s.bars ? colour(s.colour) : undefined, paths: s.bars ? uPlot.paths.bars({ size: [0.9, 60] }) : undefined,
        value: (_, v) => (v == null ? '–' : +v.toPrecision(3)),
      }))],
    }, data, box.current);
  });
  useEffect(() => {
    const resize = new ResizeObserver(() => plot.current?.setSize({ width: box.current.clientWidth, height }));
    resize.observe(box.current);
    return () => { resize.disconnect(); plot.current?.destroy(); };
  }, []);
  return (
    <figure class="chart">
      <figcaption>{title}</figcaption>
      <div ref={box} role="img" aria-label={describe ?? title} />
    </figure>
  );
}
