import { useState } from 'preact/hooks';
import { useLive } from './api.js';
import { ago, Badge, Empty, link, Loading, number, percent, Progress, short, stateOf, Tile, useClock } from './parts.jsx';

const byUrgency = (a, b) => stateOf(a).rank - stateOf(b).rank ||
  (a.lostSince ?? '').localeCompare(b.lostSince ?? '') || a.name.localeCompare(b.name);

function Row({ robot }) {
  const state = stateOf(robot);
  const answer = robot.answer ?? {};
  return (
    <tr class={state.tone}>
      <th scope="row"><a href={link('robot', robot.name)}>{short(robot.name)}</a></th>
      <td><Badge state={state} />{robot.lostSince && state.rank === 0 && <span class="dim"> {ago(robot.lostSince)}</span>}</td>
      <td class="wide">{robot.journey ? <a href={link('journey', robot.journey)}>{short(robot.journey)}</a> : '–'}</td>
      <td>{state.rank < 4 && state.rank !== 2 ? <Progress value={answer.progressHome} label={'Progress home of ' + short(robot.name)} />
        : state.rank === 2 ? `${number(robot.recordedSteps)} steps` : <span class="dim">–</span>}</td>
      <td class="num wide">{state.rank < 4 && state.rank !== 2 ? percent(answer.probability ?? 0) : '–'}</td>
      <td class="num wide">{ago(robot.lastSeen)}</td>
      <td class="num wide">{number(robot.openStreams)}</td>
      <td class="num wide">{number(robot.journeyCount)}</td>
    </tr>
  );
}

export function Fleet() {
  const { robots, up, heard } = useLive();
  useClock();
  const [filter, setFilter] = useState('');
  if (!heard) return <Loading what="The fleet" />;
  const all = [...robots.values()];
  const count = (...ranks) => all.filter((robot) => ranks.includes(stateOf(robot).rank)).length;
  const shown = all.filter((robot) => (robot.name + ' ' + (robot.journey ?? '')).includes(filter)).sort(byUrgency);
  const lost = count(0);
  return (
    <>
      <div class="tiles">
        <Tile label="lost" value={lost} tone={lost ? 'bad' : ''} />
        <Tile label="on route" value={count(3)} />
        <Tile label="ambiguous" value={count(1)} />
        <Tile label="recording" value={count(2)} />
        <Tile label="offline" value={count(4)} />
      </div>
      <p class="sr" role="status">{lost === 0 ? 'No robot is lost.' : `${lost} robots are lost.`}</p>
      {!up && <p class="error" role="alert">The link to the server is broken; this is the last known state.</p>}
      {all.length === 0 ? (
        <Empty title="No robots yet" command="homing record --journey robots/ROBOT/journeys/out --left sim:street,length=150 --right sim:street,length=150">
          A robot appears when it records or localises. This command lets a simulated one record a journey:
        </Empty>
      ) : (
        <>
          <label class="filter">Filter <input type="search" value={filter} onInput={(e) => setFilter(e.currentTarget.value)} placeholder="robot or journey" /></label>
          <div class="scroll" tabindex="0" role="region" aria-label="Robots">
            <table>
              <thead><tr><th scope="col">Robot</th><th scope="col">State</th><th scope="col" class="wide">Journey</th><th scope="col">Way home</th>
                <th scope="col" class="num wide">Probability</th><th scope="col" class="num wide">Last seen</th><th scope="col" class="num wide">Streams</th><th scope="col" class="num wide">Journeys</th></tr></thead>
              <tbody>{shown.map((robot) => <Row key={robot.name} robot={robot} />)}</tbody>
            </table>
          </div>
          {shown.length === 0 && <p class="dim">No robot fits this filter.</p>}
        </>
      )}
    </>
  );
}
