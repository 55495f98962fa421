import { useRef, useState } from 'preact/hooks';
import { useRobot } from './api.js';
import { ago, Badge, Chart, Empty, Facts, link, Loading, number, percent, Progress, short, stateOf, useClock } from './parts.jsx';

const kept = 300;
const threshold = 0.2;
const words = { DIRECTION_HOMEWARD: 'homeward', DIRECTION_OUTWARD: 'outward' };

// P_T of the best landmarks, with the line above which a landmark counts as recognised.
function Matches({ matches }) {
  const best = [...(matches ?? [])].sort((a, b) => (b.pT ?? 0) - (a.pT ?? 0)).slice(0, 8);
  return (
    <section class="card">
      <h2>Best landmarks</h2>
      {best.length === 0 ? <p class="dim">None reaches P<sub>T</sub> = {threshold.toFixed(2)} in this view.</p> : (
        <table class="matches">
          <thead><tr><th scope="col">Landmark</th><th scope="col" class="num">Step</th><th scope="col" class="num">P<sub>T</sub></th><th scope="col"><span class="sr">Bar</span></th></tr></thead>
          <tbody>{best.map((m) => (
            <tr key={m.journey + m.landmark}>
              <th scope="row">{m.landmark ?? 0} <span class="dim">{m.side === 'SIDE_LEFT' ? 'left' : 'right'}</span></th>
              <td class="num">{number(m.step)}</td><td class="num">{(m.pT ?? 0).toFixed(2)}</td>
              <td><svg class="bar" viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true"><rect width={100 * (m.pT ?? 0)} height="10" /><line x1="20" x2="20" y1="0" y2="10" /></svg></td>
            </tr>
          ))}</tbody>
        </table>
      )}
      <p class="dim">The line stands at {threshold.toFixed(2)}: above it a landmark counts as recognised.</p>
    </section>
  );
}

function Live({ robot, answer, belief, history }) {
  const x = [];
  const masses = belief?.masses ?? [];
  const each = Number(belief?.stepsEach ?? 1);
  for (let i = 0; i < masses.length; ++i) x.push(Number(belief.firstStep ?? 0) + i * each);
  const t = history.map((h) => h.t);
  return (
    <div class="grid">
      <section class="card">
        <h2>Where it is</h2>
        <Facts facts={[
          ['Journey', answer.journey ? <a href={link('journey', answer.journey)}>{short(answer.journey)}</a> : undefined],
          ['Step', answer.step === undefined ? undefined : `${number(answer.step)} of ${number(belief?.stepCount)}`],
          ['Probability', percent(answer.probability ?? 0)],
          ['Off every route', percent(answer.unknownProbability ?? 0)],
          ['Direction', words[answer.direction]],
          ['Speed ratio, steps an observation', answer.speedRatio?.toFixed(2)],
          ['Turn, rad (px if uncalibrated)', answer.turn?.toFixed(3)],
          ['Path offset, of the distance seen', answer.pathOffset?.toFixed(2)],
          ['Way home', <Progress value={answer.progressHome} label="Progress home" />],
        ]} />
      </section>
      <Matches matches={answer.matches} />
      {masses.length > 0 && <Chart title="Belief over the route" x={x} xLabel="step from home" xRange={[0, Number(belief.stepCount ?? 1)]} yLabel="probability"
        series={[{ label: 'probability', colour: 'accent', values: masses, bars: true }]} range={(_, __, max) => [0, Math.max(max, 0.01)]}
        describe={`Belief over the route; most probable at step ${answer.step ?? 'unknown'}`} />}
      <Chart title="Probability of the place" x={t} time xLabel="time" yLabel="probability" range={() => [0, 1]} series={[
        { label: 'at this place', colour: 'accent', values: history.map((h) => h.p) },
        { label: 'off every route', colour: 'bad', values: history.map((h) => h.off), dash: [6, 4] }]} />
      {history.some((h) => h.speed !== null) && <Chart title="Speed ratio" x={t} time xLabel="time" yLabel="steps an observation" range={(_, min, max) => [Math.min(min, -1.5), Math.max(max, 1.5)]}
        series={[{ label: 'speed ratio', colour: 'accent', values: history.map((h) => h.speed) }]} />}
    </div>
  );
}

export function Robot({ name }) {
  const [update, setUpdate] = useState(null);
  useClock();
  const history = useRef([]);
  useRobot(name, (next) => {
    if (next.answer && next.answer.sequence !== history.current.at(-1)?.sequence) {
      const a = next.answer;
      history.current = [...history.current.slice(1 - kept), {
        sequence: a.sequence, t: Date.now() / 1000, p: a.probability ?? 0, off: a.unknownProbability ?? 0, speed: a.speedRatio ?? null,
      }];
    }
    setUpdate(next);
  });
  if (!update) return <Loading what="The robot" />;
  const { robot, belief } = update;
  const answer = update.answer ?? robot.answer;
  return (
    <>
      <p class="lead"><Badge state={stateOf(robot)} /> last seen {ago(robot.lastSeen)} · {number(robot.journeyCount)} {robot.journeyCount === '1' ? 'journey' : 'journeys'}{' · '}
        {number(robot.observationCount)} observations since the server started</p>
      {robot.lostSince && <p class="error" role="alert">Lost {ago(robot.lostSince)}: its view fits no place of its route.</p>}
      {robot.activity === 'ACTIVITY_RECORDING' && <p>It records <a href={link('journey', robot.journey)}>{short(robot.journey)}</a>: {number(robot.recordedSteps)} steps.</p>}
      {answer ? <Live robot={robot} answer={answer} belief={belief} history={history.current} /> : (
        <Empty title="No answer yet" command={`homing localize --journey ${name}/journeys/out --left SOURCE --right SOURCE`}>
          This page follows the robot while it localises. On the robot:
        </Empty>
      )}
    </>
  );
}
