import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { call, callAll, useLoad } from './api.js';
import { directions, Profiles, readRoute, sideWord } from './route.jsx';
import { ago, bytes, Chart, colour, Empty, Facts, link, Loading, number, percent, short, themed } from './parts.jsx';

const stateWord = (journey) => (journey.state === 'STATE_FINISHED' ? 'finished' : 'active');
const page = 200;

export function Journeys() {
  const { data, error } = useLoad(() => callAll('JourneyService/ListJourneys', 'journeys', { parent: 'robots/-' }), [], 10000);
  const [filter, setFilter] = useState('');
  const [most, setMost] = useState(page);
  if (!data) return <Loading what="Journeys" error={error} />;
  if (data.length === 0) {
    return <Empty title="No journeys yet" command="homing record --journey robots/ROBOT/journeys/out --left DIR --right DIR">
      A journey is recorded on the way out:</Empty>;
  }
  const fitting = data.filter((journey) => journey.name.includes(filter));
  return (
    <>
      <label class="filter">Filter <input type="search" value={filter} onInput={(e) => setFilter(e.currentTarget.value)} placeholder="robot or journey" /></label>
      <div class="scroll" tabindex="0" role="region" aria-label="Journeys">
        <table>
          <thead><tr><th scope="col">Journey</th><th scope="col">State</th><th scope="col" class="num">Steps</th><th scope="col" class="num wide">Landmarks</th>
            <th scope="col" class="num wide">Fingerprints</th><th scope="col" class="num wide">Created</th></tr></thead>
          <tbody>{fitting.slice(0, most).map((journey) => (
            <tr key={journey.name}>
              <th scope="row"><a href={link('journey', journey.name)}>{short(journey.name)}</a></th><td>{stateWord(journey)}</td>
              <td class="num">{number(journey.stepCount)}</td><td class="num wide">{number(journey.landmarkCount)}</td>
              <td class="num wide">{number(journey.fingerprintCount)}</td><td class="num wide">{ago(journey.createTime)}</td>
            </tr>))}</tbody>
        </table>
      </div>
      {fitting.length > most && <button onClick={() => setMost(most + page)}>Show {Math.min(page, fitting.length - most)} more of {number(fitting.length)}</button>}
    </>
  );
}

// Both sides: each dot is a fingerprint, x its step, y its place along the image from the left; a colour a landmark.
function Strip({ journey, landmarks, twins }) {
  const canvas = useRef();
  const steps = Math.max(2, Number(journey.stepCount ?? 0));
  const [view, setView] = useState([0, steps]);
  const [hint, setHint] = useState('');
  const widths = [journey.settings?.leftCamera?.width || 640, journey.settings?.rightCamera?.width || 640];
  const move = (from, to) => {
    const size = Math.min(steps, Math.max(10, to - from));
    const first = Math.min(Math.max(0, from), steps - size);
    setView([first, first + size]);
  };
  const zoom = (factor, at = (view[0] + view[1]) / 2) => move(at - (at - view[0]) * factor, at + (view[1] - at) * factor);
  const keys = (event) => {
    const size = view[1] - view[0];
    const act = { '+': () => zoom(0.5), '=': () => zoom(0.5), '-': () => zoom(2), ArrowLeft: () => move(view[0] - size / 5, view[1] - size / 5),
      ArrowRight: () => move(view[0] + size / 5, view[1] + size / 5), Home: () => move(0, size), End: () => move(steps - size, steps), 0: () => move(0, steps) }[event.key];
    if (act) { event.preventDefault(); act(); }
  };
  const theme = themed();
  useEffect(() => {
    const draw = () => {
      const c = canvas.current;
      const scale = devicePixelRatio || 1;
      const w = c.clientWidth, h = c.clientHeight;
      c.width = w * scale; c.height = h * scale;
      const g = c.getContext('2d');
      g.scale(scale, scale);
      const lane = (h - 30) / 2;
      const px = (step) => (w * (step - view[0])) / (view[1] - view[0]);
      g.font = '12px system-ui';
      g.strokeStyle = colour('line');
      g.fillStyle = colour('text');
      const size = view[1] - view[0];
      const tick = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 50000].find((t) => size / t <= w / 70) ?? 100000;
      for (let s = Math.ceil(view[0] / tick) * tick; s <= view[1]; s += tick) {
        g.beginPath(); g.moveTo(px(s), 0); g.lineTo(px(s), 2 * lane); g.stroke();
        const half = g.measureText(s).width / 2;
        g.fillText(s, Math.min(Math.max(px(s), half), w - half) - half, h - 4);
      }
      g.beginPath(); g.moveTo(0, lane); g.lineTo(w, lane); g.stroke();
      for (const l of landmarks) {
        const right = l.side === 'SIDE_RIGHT';
        g.fillStyle = `hsl(${((l.landmark ?? 0) * 137) % 360} 60% ${matchMedia('(prefers-color-scheme: dark)').matches && document.documentElement.dataset.theme !== 'light' || document.documentElement.dataset.theme === 'dark' ? 65 : 38}%)`;
        const s = l.steps ?? [];
        for (let i = 0; i < s.length; ++i) {
          if (s[i] < view[0] - 1 || s[i] > view[1] + 1) continue;
          const y = (right ? lane : 0) + 4 + ((lane - 8) * (l.xs?.[i] ?? 0)) / widths[right ? 1 : 0];
          const r = Math.min(5, 1 + Math.sqrt(l.counts?.[i] ?? 1) / 4);
          g.fillRect(px(s[i]) - r, y - r, 2 * r, 2 * r);
        }
      }
      g.fillStyle = g.strokeStyle = colour('bad');
      for (const t of twins) for (const s of [t.firstStep ?? 0, t.secondStep ?? 0]) {
        const x = Math.min(Math.max(px(s), 4), w - 4);
        g.beginPath(); g.moveTo(x, 2 * lane); g.lineTo(x - 4, 2 * lane + 8); g.lineTo(x + 4, 2 * lane + 8); g.fill();
      }
      g.fillStyle = colour('text');
      g.fillText('left side', 6, 14); g.fillText('right side', 6, lane + 14);
    };
    draw();
    const resize = new ResizeObserver(draw);
    resize.observe(canvas.current);
    return () => resize.disconnect();
  }, [view, landmarks, twins, theme]);
  const stepAt = (event) => { const box = canvas.current.getBoundingClientRect(); return view[0] + ((event.clientX - box.left) / box.width) * (view[1] - view[0]); };
  const point = (event) => {
    const step = Math.round(stepAt(event));
    const here = landmarks.filter((l) => l.firstStep <= step && l.lastStep >= step);
    setHint(`step ${step}: ${here.length ? 'landmarks ' + here.map((l) => l.landmark ?? 0).join(', ') : 'no landmark'}`);
  };
  return (
    <figure class="chart">
      <figcaption>Landmarks over the steps <span class="dim">(x: step from home; y: place along the image, its left on top; size: vectors; ▲ places that look alike)</span></figcaption>
      <div class="buttons"><button onClick={() => zoom(0.5)}>Zoom in</button><button onClick={() => zoom(2)}>Zoom out</button><button onClick={() => move(0, steps)}>All</button>
        <span class="dim" role="status">{hint || `steps ${Math.floor(view[0])} to ${Math.ceil(view[1])}; keys + − ← → Home End 0`}</span></div>
      <canvas class="strip" ref={canvas} tabindex="0" role="img" aria-label={`${landmarks.length} landmarks on ${steps} steps`} onKeyDown={keys}
        onPointerMove={point} onWheel={(event) => { event.preventDefault(); zoom(event.deltaY > 0 ? 1.25 : 0.8, stepAt(event)); }} />
    </figure>
  );
}

// As `homing journeys show` judges it.
function qualityOf(journey) {
  const steps = Number(journey.stepCount ?? 0), fingerprints = Number(journey.fingerprintCount ?? 0);
  if (steps === 0) return 'POOR: it has no step';
  if (fingerprints === 0) return 'POOR: it has no fingerprint; the frames hardly differ, or the camera sees too little that is near';
  if (fingerprints * 10 < steps) return `POOR: only ${fingerprints} fingerprints in ${steps} steps`;
  return 'GOOD';
}

export function Journey({ name, session }) {
  const { data, error } = useLoad(async () => {
    const [journey, landmarks, aliasing, described] = await Promise.all([
      call('JourneyService/GetJourney', { name }),
      callAll('JourneyService/ListLandmarks', 'landmarks', { parent: name, includeFingerprints: true }).catch((e) => { if (e.status === 403) return []; throw e; }),
      call('JourneyService/AnalyzeAliasing', { name }).catch(() => null),
      call('JourneyService/DescribeRoute', { name }).catch(() => null),
    ]);
    for (const l of landmarks) { l.steps = (l.steps ?? []).map(Number); l.firstStep = Number(l.firstStep ?? 0); l.lastStep = Number(l.lastStep ?? 0); }
    return { journey, landmarks, aliasing, described, route: readRoute(described) };
  }, [name]);
  const [said, say] = useState('');
  const counts = useMemo(() => {
    if (!data) return null;
    const steps = Number(data.journey.stepCount ?? 0), groups = Math.min(steps, 400) || 1, each = Math.max(1, Math.ceil(steps / groups));
    const sum = new Array(Math.ceil(steps / each) || 1).fill(0);
    for (const l of data.landmarks) l.steps.forEach((s) => { sum[Math.floor(s / each)] += 1; });
    return { x: sum.map((_, i) => i * each), y: sum.map((v) => v / each) };
  }, [data]);
  if (!data) return <Loading what="The journey" error={error} />;
  const { journey, landmarks, aliasing, described, route } = data;
  const sides = Object.entries(route.sides);
  const longest = Math.max(0, ...sides.map(([, s]) => s.flow.length));
  const twins = aliasing?.twins ?? [];
  const change = async (method, what) => {
    if (!confirm(`${what} ${short(name)}?`)) return;
    try { await call('JourneyService/' + method, { name }); say(`${what}: done.`); if (method === 'DeleteJourney') location.hash = '#/journeys'; else location.reload(); } catch (e) { say(e.message); }
  };
  return (
    <>
      <section class="card"><Facts facts={[
        ['State', stateWord(journey)], ['Quality', qualityOf(journey)], ['Steps', number(journey.stepCount)], ['Landmarks', number(journey.landmarkCount)],
        ['Fingerprints', number(journey.fingerprintCount)], ['Map', described ? bytes(Number(described.mapBytes ?? 0)) : undefined],
        ['Cameras look', directions(described)], ['Created', ago(journey.createTime)],
        ['Readers', (journey.readers ?? []).map((r) => (r === '*' ? 'all robots' : r)).join(', ') || 'the owner alone'],
        ['A place is known after', aliasing?.medianSteps ? `${aliasing.medianSteps} steps (median)` : undefined],
        ['Indistinct places', aliasing ? percent(aliasing.indistinctShare ?? 0, 1) : undefined]]} />
      {session.role !== 'robot' && session.role !== 'localise-only' && (
        <div class="buttons">
          {session.role === 'admin' && stateWord(journey) === 'active' && <button onClick={() => change('FinishJourney', 'Finish')}>Finish</button>}
          <button class="danger" onClick={() => change('DeleteJourney', 'Delete')}>Delete</button><span role="status">{said}</span>
        </div>)}
      </section>
      {landmarks.length === 0 ? <Empty title="No landmarks" command={`homing journeys show ${name}`}>Nothing was recorded yet, or this login may not read the map.</Empty> : (
        <>
          <Strip journey={journey} landmarks={landmarks} twins={twins} />
          <Chart title="Fingerprints at each step" x={counts.x} xLabel="step from home" yLabel="fingerprints" whole range={(_, __, max) => [0, Math.max(max, 1)]} series={[{ label: 'fingerprints a step', colour: 'accent', values: counts.y, bars: true }]} />
        </>)}
      {longest > 0 && (
        <>
          <Profiles route={route} steps={Number(journey.stepCount ?? 0)} />
          <Chart title="Flow from step to step" x={Array.from({ length: longest }, (_, i) => i * route.each)} xLabel="step from home" yLabel="median flow, px"
            series={sides.map(([side, s], i) => ({ label: sideWord(side), colour: i ? 'warn' : 'accent', dash: i ? [6, 4] : undefined, values: s.flow.map(Math.abs) }))} />
        </>)}
      {twins.length > 0 && (
        <section class="card"><h2>Places that look alike</h2>
          <div class="scroll"><table><thead><tr><th scope="col" class="num">Step</th><th scope="col" class="num">Looks like</th><th scope="col" class="num">Confusion</th><th scope="col"><span class="sr">Comparison</span></th></tr></thead>
            <tbody>{twins.map((t) => <tr key={t.firstStep + '-' + t.secondStep}><td class="num">{number(t.firstStep)}</td><td class="num">{number(t.secondStep)}</td><td class="num">{percent(t.confusion ?? 0)}</td>
              <td><a href={`#/match/${name}?a=${t.firstStep ?? 0}&b=${t.secondStep ?? 0}`} aria-label={`Compare steps ${t.firstStep ?? 0} and ${t.secondStep ?? 0}`}>compare</a></td></tr>)}</tbody></table></div>
        </section>)}
      <p><a href={link('match', name)}>Compare two steps of this journey</a></p>
    </>
  );
}
