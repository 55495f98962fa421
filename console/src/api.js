// The server's API: each method of gRPC by its name, with JSON.
import { useEffect, useState } from 'preact/hooks';
import { createFeed } from './feed.js';

export class ApiError extends Error {
  constructor(status, body) {
    super(body.message || `The server answered ${status}.`);
    this.status = status;
    this.code = body.code || '';
  }
}
let session = null;
async function read(response) {
  const body = await response.json().catch(() => ({}));
  if (!response.ok) throw new ApiError(response.status, body);
  return body;
}
export const getSession = async () => (session = await fetch('/api/v1/session').then(read));
export const logIn = (token) =>
  fetch('/api/v1/login', { method: 'POST', body: JSON.stringify({ token }) }).then(read);
export const logOut = () => fetch('/api/v1/logout', { method: 'POST' }).then(read);
const post = (method, request) =>
  fetch('/api/v1/' + method, {
    method: 'POST', headers: { 'X-CSRF-Token': session?.csrf ?? '' }, body: JSON.stringify(request),
  }).then(read);
// A server that was restarted has new tokens, and knows no login of before: calls are tried again with the new token.
export async function call(method, request = {}) {
  const used = session?.csrf;
  try {
    return await post(method, request);
  } catch (error) {
    if (![401, 403].includes(error.status)) throw error;
    await renew();
    if (session?.csrf === used) throw error;
    return post(method, request);
  }
}
// Calls back with true when the server asks for a login, and with false when another tab has logged in.
let onLogin = () => {};
let away = false;
export const whenLogin = (hear) => { onLogin = hear; };
const renew = () => getSession().catch((error) => {
  if (error.status === 401) { away = true; onLogin(true); }
});

// All pages of a list.
export async function callAll(method, field, request = {}, most = 20000) {
  const all = [];
  let pageToken = '';
  do {
    const page = await call(method, { pageSize: 1000, ...request, pageToken });
    for (const item of page[field] ?? []) all.push(item);
    pageToken = page.nextPageToken ?? '';
  } while (pageToken && all.length < most);
  return all;
}

// {data, error}; loaded again when `keys` change, and every `every` ms.
export function useLoad(load, keys, every = 0) {
  const [state, setState] = useState({});
  useEffect(() => {
    let live = true;
    const run = () => load().then((data) => live && setState({ data }), (error) => live && setState((old) => ({ ...old, error })));
    setState({});
    run();
    const timer = every ? setInterval(run, every) : 0;
    return () => { live = false; clearInterval(timer); };
  }, keys);
  return state;
}

// -- The live state: robots by name, and the updates of the robot that this page shows.
const listeners = new Set();
export const live = { robots: new Map(), up: false, heard: false };
let waiting = false;
let send = () => {};
// At most one round a frame.
function announce() {
  if (waiting) return;
  waiting = true;
  setTimeout(() => { waiting = false; for (const listener of listeners) listener(); }, 50);
}
function receive(message) {
  if (message.kind === 'link') live.up = message.up;
  if (message.kind === 'link' && message.up && away) { away = false; onLogin(false); }
  if (message.kind === 'refused') renew();
  if (message.kind === 'fleet') {
    if (message.whole && !message.cached) live.robots.clear();
    for (const robot of message.robots) live.robots.set(robot.name, robot);
    live.up = live.up || !message.cached;
    live.heard = live.heard || !message.cached || message.robots.length > 0;
  }
  if (message.kind === 'robot') for (const hear of robotListeners) hear(message.update);
  announce();
}
const robotListeners = new Set();
let started = false;
export function startLive() {
  if (started) return;
  started = true;
  if (window.SharedWorker) {
    const { port } = new SharedWorker('/worker.js');
    port.onmessage = ({ data }) => receive(data);
    send = (robot) => port.postMessage({ robot });
    addEventListener('pagehide', () => port.postMessage({ bye: true }));
    addEventListener('pageshow', (event) => event.persisted && send(''));
  } else {
    const feed = createFeed(receive);
    send = (robot) => feed.watch(robot ? [robot] : []);
  }
  send('');
}
export function useLive() {
  const [, redraw] = useState(0);
  useEffect(() => {
    const listener = () => redraw((n) => n + 1);
    listeners.add(listener);
    return () => listeners.delete(listener);
  }, []);
  return live;
}
export function useRobot(name, hear) {
  useEffect(() => {
    const own = (update) => update.robot?.name === name && hear(update);
    robotListeners.add(own);
    send(name);
    return () => { robotListeners.delete(own); send(''); };
  }, [name]);
}
