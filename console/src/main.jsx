import 'uplot/dist/uPlot.min.css';
import './app.css';
import { render } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { getSession, logIn, logOut, startLive, useLive, whenLogin } from './api.js';
import { Fleet } from './fleet.jsx';
import { Journey, Journeys } from './journeys.jsx';
import { Match, Models } from './models.jsx';
import { Empty, Loading, short } from './parts.jsx';
import { Robot } from './robot.jsx';
import { Server } from './server.jsx';

const nav = [['fleet', 'Fleet'], ['journeys', 'Journeys'], ['models', 'Models'], ['server', 'Server']];

// "#/robot/robots/r1?x=y" -> the page, the name and the query.
function route() {
  const [path, query] = location.hash.slice(2).split('?');
  const [page, ...name] = path.split('/');
  return { page: page || 'fleet', name: decodeURIComponent(name.join('/')), query: new URLSearchParams(query) };
}

function Page({ at, session }) {
  switch (at.page) {
    case 'fleet': return <Fleet />;
    case 'journeys': return <Journeys />;
    case 'journey': return <Journey key={at.name} name={at.name} session={session} />;
    case 'robot': return <Robot key={at.name} name={at.name} />;
    case 'match': return <Match key={at.name} name={at.name} query={at.query} />;
    case 'models': return <Models />;
    case 'server': return <Server session={session} />;
    default: return <Empty title="No such page"><a href="#/fleet">To the fleet</a></Empty>;
  }
}

function Login({ done, reason }) {
  const [error, setError] = useState(reason);
  const submit = async (event) => {
    event.preventDefault();
    try { await logIn(event.currentTarget.token.value.trim()); history.replaceState(null, '', '#/fleet'); done(); } catch (e) { setError(e.message); }
  };
  return (
    <main class="login"><h1>Homing</h1>
      <form class="card" onSubmit={submit}>
        <label for="token">Token</label>
        <input id="token" name="token" type="password" autocomplete="current-password" required autofocus />
        <button class="primary">Log in</button>
        {error && <p class="error" role="alert">{error}</p>}
      </form>
      <p class="dim">An administrator makes a token with:</p>
      <pre tabindex="0"><code>homing-server token operators/NAME --tokens FILE --out TOKEN</code></pre>
    </main>
  );
}

function Theme() {
  const [theme, set] = useState(localStorage.theme ?? '');
  useEffect(() => { document.documentElement.dataset.theme = localStorage.theme = theme; }, [theme]);
  return <label class="theme"><span class="sr">Theme</span><select value={theme} onChange={(e) => set(e.currentTarget.value)}>
    <option value="">Auto</option><option value="light">Light</option><option value="dark">Dark</option></select></label>;
}

function Link() {
  const { up, heard } = useLive();
  return <span class={'link ' + (up ? 'good' : 'bad')} role="status">{up ? '● live' : heard ? '▲ no link' : '○ connecting'}</span>;
}

function Shell({ session, leave }) {
  const [at, go] = useState(route());
  const heading = useRef();
  useEffect(() => {
    const change = () => { go(route()); scrollTo(0, 0); heading.current?.focus({ preventScroll: true }); };
    addEventListener('hashchange', change);
    return () => removeEventListener('hashchange', change);
  }, []);
  const title = at.name ? short(at.name) : nav.find(([page]) => page === at.page)?.[1] ?? 'Homing';
  const prefix = { robot: 'Robot ', journey: 'Journey ', match: 'Match explorer: ' }[at.page] ?? '';
  useEffect(() => { document.title = `${prefix}${title} – Homing`; });
  const section = { robot: 'fleet', journey: 'journeys', match: 'journeys' }[at.page] ?? at.page;
  return (
    <>
      <a class="skip" href="#main" onClick={(e) => { e.preventDefault(); heading.current?.focus(); }}>Skip to the content</a>
      <header><a class="brand" href="#/fleet"><img src="/icon.svg" alt="" width="24" height="24" /> Homing</a>
        <nav aria-label="Pages">{nav.map(([page, word]) => <a key={page} href={'#/' + page} aria-current={section === page ? 'page' : undefined}>{word}</a>)}</nav>
        <div class="aside"><Link /><Theme />{!session.open && <button onClick={leave} title={`${session.identity} (${session.role})`}>Log out</button>}</div></header>
      <main id="main"><h1 tabindex="-1" ref={heading}>{prefix}{title}</h1><Page at={at} session={session} /></main>
    </>
  );
}

function App() {
  const [session, setSession] = useState(null);
  const [refused, refuse] = useState(null);
  const enter = () => getSession().then((s) => { startLive(); setSession(s); refuse(null); }, (e) => refuse(e));
  useEffect(() => { document.documentElement.dataset.theme = localStorage.theme ?? ''; whenLogin((needed) => (needed ? refuse({ status: 401 }) : enter())); enter(); }, []);
  if (refused?.status === 401) {
    const used = route().query.get('link') === 'used';
    return <Login done={enter} reason={used ? 'This link was used, or is older than 15 minutes.' : ''} />;
  }
  if (refused) return <main><Loading what="The console" error={refused} /></main>;
  if (!session) return <main><Loading what="The console" /></main>;
  return <Shell session={session} leave={() => logOut().finally(() => location.reload())} />;
}

render(<App />, document.getElementById('app'));
