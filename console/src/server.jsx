import { useLoad } from './api.js';
import { ago, bytes, Facts, Loading, number, Tile } from './parts.jsx';

// Prometheus' text: [{name, labels, value}].
function parse(text) {
  const samples = [];
  for (const line of text.split('\n')) {
    const found = /^([a-zA-Z_:][\w:]*)(?:\{(.*)\})? (\S+)/.exec(line);
    if (!found) continue;
    const labels = {};
    for (const [, key, value] of (found[2] ?? '').matchAll(/(\w+)="((?:[^"\\]|\\.)*)"/g)) labels[key] = value;
    samples.push({ name: found[1], labels, value: Number(found[3]) });
  }
  return samples;
}

export function Server({ session }) {
  const { data, error } = useLoad(() => fetch('/metrics').then((r) => r.text()).then(parse), [], 3000);
  if (!data) return <Loading what="The server" error={error} />;
  const value = (name, labels = {}) => data.find((s) => s.name === name && Object.entries(labels).every(([k, v]) => s.labels[k] === v))?.value;
  const sum = (name) => data.filter((s) => s.name === name).reduce((total, s) => total + s.value, 0);
  const end = value('homing_certificate_end_timestamp_seconds');
  const start = value('process_start_time_seconds');
  const days = end ? Math.floor((end - Date.now() / 1000) / 86400) : undefined;
  const limits = data.filter((s) => s.name === 'homing_limit').sort((a, b) => a.labels.limit.localeCompare(b.labels.limit));
  const isBytes = (name) => /bytes|database|quota|message/.test(name);
  const setTo = ({ labels: { limit }, value: v }) =>
    v === 0 ? 'none' : isBytes(limit) ? bytes(v) : number(v) + (limit.endsWith('-s') ? ' s' : limit.endsWith('-rate') ? ' a second' : limit.endsWith('-pixels') ? ' px' : '');
  const errors = data.filter((s) => s.name === 'homing_errors_total' && s.value > 0).sort((a, b) => b.value - a.value);
  return (
    <>
      <div class="tiles">
        <Tile label="open streams" value={number(value('homing_open_streams'))} />
        <Tile label="database" value={bytes(value('homing_db_size_bytes') ?? 0)} />
        <Tile label="memory" value={bytes(value('process_resident_memory_bytes') ?? 0)} />
        <Tile label="errors" value={number(sum('homing_errors_total'))} />
        {days !== undefined && <Tile label="days of certificate" value={number(days)} tone={days < 30 ? 'bad' : ''} />}
      </div>
      <div class="grid">
        <div><section class="card"><h2>Server</h2><Facts facts={[['Version', session.version], ['Started', start ? ago(new Date(start * 1000).toISOString()) : undefined],
          ['Observations received', number(sum('homing_observations_received_total'))], ['Observations made durable', number(value('homing_db_appends_total'))],
          ['Waiting for the disk', number(value('homing_ingest_queue_depth'))], ['Waiting for a worker', number(value('homing_worker_queue_depth'))],
          ['Open files', number(value('process_open_fds'))], ['Certificate ends', end ? new Date(end * 1000).toISOString().slice(0, 10) : 'no TLS']]} /></section>
        <section class="card"><h2>Errors since the start</h2>{errors.length === 0 ? <p class="dim">None.</p> : <table><thead><tr><th scope="col">Code</th><th scope="col">Reason</th><th scope="col" class="num">Calls</th></tr></thead>
          <tbody>{errors.slice(0, 12).map((e) => <tr key={e.labels.code + e.labels.reason}><td>{e.labels.code}</td><td>{e.labels.reason || '–'}</td><td class="num">{number(e.value)}</td></tr>)}</tbody></table>}</section></div>
        <section class="card"><h2>Limits</h2><div class="scroll"><table><thead><tr><th scope="col">Limit</th><th scope="col" class="num">Set to</th></tr></thead>
          <tbody>{limits.map((l) => <tr key={l.labels.limit}><th scope="row"><code>--{l.labels.limit}</code></th><td class="num">{setTo(l)}</td></tr>)}</tbody></table></div></section>
      </div>
    </>
  );
}
