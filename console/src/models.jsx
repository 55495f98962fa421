import { useState } from 'preact/hooks';
import { call, callAll, useLoad } from './api.js';
import { Chart, Empty, Facts, Loading, number, short } from './parts.jsx';
import { readRoute, View } from './route.jsx';

const paper = { name: 'deviationModels/default', mu: 2.24, sigma: 0.86 };

// The error function, to 1e-7 (Abramowitz and Stegun 7.1.26).
function erf(x) {
  const t = 1 / (1 + 0.3275911 * Math.abs(x));
  const y = 1 - ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t * Math.exp(-x * x);
  return Math.sign(x) * y;
}
// 1 - F(delta) of the log-normal (eq 14).
export const survival = (delta, { mu, sigma }) => (delta <= 0 ? 1 : 0.5 * (1 - erf((Math.log(delta) - mu) / (sigma * Math.SQRT2))));
const density = (delta, { mu, sigma }) => (delta <= 0 ? 0 : Math.exp(-(((Math.log(delta) - mu) / sigma) ** 2) / 2) / (delta * sigma * Math.sqrt(2 * Math.PI)));

export function Models() {
  const { data, error } = useLoad(() => callAll('DeviationModelService/ListDeviationModels', 'models'), []);
  const [chosen, choose] = useState('');
  if (!data) return <Loading what="Models" error={error} />;
  const models = data.length ? data : [paper];
  const model = { ...paper, ...(models.find((m) => m.name === chosen) ?? models[0]) };
  const x = Array.from({ length: 201 }, (_, i) => i * 0.5);
  return (
    <>
      <label class="filter">Model <select value={model.name} onChange={(e) => choose(e.currentTarget.value)}>
        {models.map((m) => <option key={m.name} value={m.name}>{m.name.replace('deviationModels/', '')}</option>)}</select></label>
      <section class="card"><Facts facts={[['μ of ln(deviation/px)', model.mu.toFixed(3)], ['σ', model.sigma.toFixed(3)],
        ['Training observations', model.observations ? number(model.observations) : 'built in'], ['Kolmogorov–Smirnov distance', model.ksDistance?.toFixed(4)]]} /></section>
      <div class="grid">
        <Chart title="Density of deviations (Fig. 1)" x={x} xLabel="deviation, px" yLabel="density, 1/px" series={[{ label: 'density', colour: 'accent', values: x.map((d) => density(d, model)) }]} />
        <Chart title="Similarity P of two means (Fig. 2)" x={x} xLabel="distance δ, px" yLabel="P = 1 − F(δ)" range={() => [0, 1]} series={[{ label: 'P', colour: 'accent', values: x.map((d) => survival(d, model)) }]} />
      </div>
      {data.length < 2 && <Empty title="No model of your own" command="homing train --width 640 --height 480 --focal 554">The built-in model is the paper's. A model of your own camera is trained by:</Empty>}
    </>
  );
}

// -- Match explorer: two steps of one journey, side by side.
const at = (landmarks, step) => landmarks.flatMap((l) => {
  const i = (l.steps ?? []).indexOf(step);
  return i < 0 ? [] : [{ id: l.landmark ?? 0, side: l.side, x: l.xs?.[i] ?? 0, y: l.ys?.[i] ?? 0, count: l.counts?.[i] ?? 0 }];
});

export function Match({ name, query }) {
  const [a, setA] = useState(Number(query.get('a') ?? 0));
  const [b, setB] = useState(Number(query.get('b') ?? 1));
  const { data, error } = useLoad(async () => {
    const journey = await call('JourneyService/GetJourney', { name });
    const landmarks = await callAll('JourneyService/ListLandmarks', 'landmarks', { parent: name, includeFingerprints: true });
    for (const l of landmarks) l.steps = (l.steps ?? []).map(Number);
    const model = await call('DeviationModelService/GetDeviationModel', { name: journey.settings?.deviationModel || paper.name }).catch(() => paper);
    return { journey, landmarks, model };
  }, [name]);
  const views = useLoad(() => Promise.all([a, b].map((step) =>
    call('JourneyService/DescribeRoute', { name, firstStep: step, lastStep: step }).then(readRoute, () => readRoute(null)))), [name, a, b]);
  if (!data) return <Loading what="The journey" error={error} />;
  const [routeA, routeB] = views.data ?? [readRoute(null), readRoute(null)];
  const partners = (own) => new Set(pairs.filter((p) => p.pt >= 0.2).map((p) => p[own].id));
  const last = Math.max(0, Number(data.journey.stepCount ?? 0) - 1);
  const first = at(data.landmarks, a), second = at(data.landmarks, b);
  const pairs = first.flatMap((l) => second.filter((r) => r.side === l.side).map((r) => {
    const delta = Math.hypot(l.x - r.x, l.y - r.y);
    const p = survival(delta, data.model);
    return { l, r, delta, p, pt: (p * Math.min(l.count, r.count)) / Math.max(l.count, r.count, 1) };
  })).sort((p, q) => q.pt - p.pt);
  const input = (label, value, set) => <label>{label} <input type="number" min="0" max={last} value={value} onInput={(e) => set(Math.min(last, Math.max(0, Math.round(Number(e.currentTarget.value)))))} /></label>;
  const sides = [['SIDE_LEFT', 'left', data.journey.settings?.leftCamera], ['SIDE_RIGHT', 'right', data.journey.settings?.rightCamera]]
    .filter(([side]) => first.concat(second).some((f) => f.side === side) || routeA.sides[side] || routeB.sides[side]);
  return (
    <>
      <div class="buttons">{input('First step', a, setA)} {input('Second step', b, setB)} <span class="dim">0 to {number(last)}</span></div>
      <p class="dim">Circles are landmarks at the mean of their flow vectors; the area is the number of vectors. The server keeps no vectors, but a coarse flow profile: a line is the mean flow of a cell, thick where many vectors are; the bars are the vectors along x, and the dashed line is the valley that divides two landmarks. Filled circles: P<sub>T</sub> of at least 0.20 with one of the other step.</p>
      {sides.length === 0 && <Empty title="Nothing to compare" command={`homing journeys show ${name}`}>Neither step has a landmark. The landmarks' steps are listed by:</Empty>}
      {sides.map(([side, word, camera]) => (
        <div class="grid" key={side}>
          <View title={`Step ${a}, ${word}`} seen={first.filter((f) => f.side === side)} camera={camera} partners={partners('l')} route={routeA} side={side} />
          <View title={`Step ${b}, ${word}`} seen={second.filter((f) => f.side === side)} camera={camera} partners={partners('r')} route={routeB} side={side} />
        </div>))}
      {pairs.length > 0 && (
        <div class="scroll" tabindex="0" role="region" aria-label="Pairs of landmarks"><table>
          <thead><tr><th scope="col">Side</th><th scope="col" class="num"><span class="wide">Landmark </span>at {a}</th><th scope="col" class="num"><span class="wide">Landmark </span>at {b}</th><th scope="col" class="num wide">Vectors</th><th scope="col" class="num">δ, px</th><th scope="col" class="num">P</th><th scope="col" class="num">P<sub>T</sub></th></tr></thead>
          <tbody>{pairs.slice(0, 12).map((p) => <tr key={p.l.id + '-' + p.r.id}><td>{p.l.side === 'SIDE_LEFT' ? 'left' : 'right'}</td><td class="num">{p.l.id}</td><td class="num">{p.r.id}</td>
            <td class="num wide">{p.l.count} / {p.r.count}</td><td class="num">{p.delta.toFixed(1)}</td><td class="num">{p.p.toFixed(2)}</td><td class="num">{p.pt >= 0.2 ? <strong>{p.pt.toFixed(2)}</strong> : p.pt.toFixed(2)}</td></tr>)}</tbody>
        </table></div>)}
      <p><a href={'#/journey/' + name}>Back to {short(name)}</a></p>
    </>
  );
}
