// The console in Chromium against a live server: usage node console.mjs SERVER PROTOS OUT
import { spawn } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import axeModule from '@axe-core/playwright';
import { chromium } from 'playwright-core';
import { Fleet } from './fleet.mjs';

const Axe = axeModule.default ?? axeModule;
const [server, protos, out] = process.argv.slice(2);
const grpcPort = 50770 + (process.pid % 100), httpPort = 18770 + (process.pid % 100);
const address = `127.0.0.1:${grpcPort}`, url = `http://127.0.0.1:${httpPort}`;
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
let failed = 0, child;
const check = (what, good, more = '') => { console.log(`${good ? 'ok' : 'FAILED'}: ${what}${more === '' ? '' : ': ' + more}`); if (!good) failed = 1; };
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
async function until(test, ms = 15000) {
  const begin = performance.now();
  while (performance.now() - begin < ms) { if (await test().catch(() => false)) return performance.now() - begin; await pause(20); }
  return Infinity;
}
function start(...more) {
  child = spawn(server, ['--listen', address, '--http', `127.0.0.1:${httpPort}`, '--database', `sqlite:${out}/homing.db`, ...more], { stdio: ['ignore', 'pipe', 'ignore'] });
  child.text = '';
  child.stdout.on('data', (data) => { child.text += data; });
  return until(() => ask('/healthz').then((a) => a.status === 200));
}
const stop = (signal = 'SIGTERM') => new Promise((done) => { child.on('exit', done); child.kill(signal); });
// With headers that fetch would not send.
const ask = (path, { method = 'GET', headers = {}, body } = {}) => new Promise((done, fail) => {
  const request = http.request(url + path, { method, headers, agent: false }, (answer) => {
    let text = ''; answer.on('data', (d) => { text += d; }).on('end', () => done({ status: answer.statusCode, headers: answer.headers, text }));
  });
  request.on('error', fail);
  request.end(body);
});

const journey = 'robots/r000/journeys/out', steps = 200;
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
try {
  await start();
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  const problems = [];
  page.on('console', (m) => m.type() === 'error' && !/ERR_CONNECTION|ERR_INCOMPLETE|503/.test(m.text()) && problems.push(m.text()));
  page.on('pageerror', (e) => problems.push(e.message));
  const visit = async (hash, ready = 'main h1') => { await page.goto(url + '/#/' + hash); await page.waitForSelector(ready); await pause(400); };
  const shot = async (name, theme, phone) => {
    await page.setViewportSize(phone ? { width: 390, height: 844 } : { width: 1280, height: 800 });
    await page.evaluate((t) => { localStorage.theme = t; document.documentElement.dataset.theme = t; }, theme);
    await page.reload();
    await page.waitForSelector('main h1');
    await pause(1300);
    await page.screenshot({ path: `${out}/${name}-${theme}${phone ? '-phone' : ''}.png`, fullPage: true });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    check(`${name} ${theme}${phone ? ' phone' : ''} fits its width`, wide <= 0, wide);
    const { violations } = await new Axe({ page }).analyze();
    const bad = violations.filter((v) => ['serious', 'critical'].includes(v.impact));
    check(`${name} ${theme}${phone ? ' phone' : ''}: axe`, bad.length === 0, bad.map((v) => v.id + ' ' + v.nodes[0].html.slice(0, 100)).join('; '));
  };
  await visit('fleet', '.empty');
  await shot('fleet-empty', 'light');
  await visit('journeys', '.empty');
  check('empty states print the command', (await page.textContent('.empty pre')).includes('homing record'));

  const fleet = new Fleet(address, protos);
  const robot = (i) => 'r' + String(i).padStart(3, '0');
  for (let i = 0; i < 100; ++i) {
    await fleet.create(robot(i), 'out');
    await Promise.all([1, 2, 3, 4].map((j) => fleet.create(robot(i), 'spare' + j)));
  }
  await fleet.record('r000', 'out', steps);
  for (let i = 1; i < 90; ++i) fleet.drive(robot(i), journey, steps, 1, (i * 2) % steps).burst(15);
  fleet.robots.get('r007').lose();
  fleet.robots.get('r007').burst(60);

  await visit('fleet', 'tbody tr');
  check('all robots are shown', (await until(async () => (await page.locator('tbody tr').count()) === 100)) < 15000);
  check('a lost robot is found', (await until(async () => (await page.textContent('tbody tr th')) === 'r007')) < 15000);
  await page.evaluate(() => {
    window.tasks = [];
    new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map((e) => e.duration))).observe({ type: 'longtask' });
  });
  await pause(8000);
  const tasks = await page.evaluate(() => window.tasks);
  check('no task over 50 ms in 8 s', tasks.length === 0, tasks.join(' '));
  // From the answer at the server to the top of the page.
  const loser = fleet.robots.get('r042');
  loser.lose();
  let sees = 0;
  for (let i = 0; i < 200 && loser.answer?.outcome !== 'OUTCOME_UNKNOWN_PLACE'; ++i) { loser.burst(1); await pause(30); }
  sees = await until(async () => (await page.locator('tbody tr.bad th').allTextContents()).includes('r042'));
  check('a robot that gets lost is on top within a second', sees < 1000, Math.round(sees) + ' ms');

  const views = [['fleet', 'fleet'], ['robot/robots/r001', 'robot'], ['journeys', 'journeys'], ['journey/' + journey, 'journey'],
    ['match/' + journey + '?a=20&b=22', 'match'], ['models', 'models'], ['server', 'server']];
  for (const [hash, name] of views) {
    await visit(hash);
    for (const theme of ['light', 'dark']) for (const phone of [false, true]) await shot(name, theme, phone);
  }
  check('no error in the browser', problems.length === 0, problems.join('; '));

  await page.setViewportSize({ width: 1280, height: 800 });
  await visit('fleet', 'tbody tr');
  for (let i = 0; i < 9; ++i) { await page.keyboard.press('Tab'); }
  check('the keyboard reaches the robots', await page.evaluate(() => document.activeElement !== document.body));

  const tabs = [];
  for (let i = 0; i < 7; ++i) { const tab = await page.context().newPage(); tabs.push(tab); await tab.goto(url + '/#/fleet'); }
  const shown = await Promise.all(tabs.map((tab) => tab.waitForSelector('tbody tr', { timeout: 8000 }).then(() => true, () => false)));
  check('eight tabs at once', shown.every(Boolean));
  for (const tab of tabs) await tab.close();

  // What ten consoles cost the server, in seconds of processor a second: the middle one of three measurements.
  await page.goto('about:blank');
  const used = () => { const f = readFileSync(`/proc/${child.pid}/stat`, 'utf8').split(') ')[1].split(' '); return (Number(f[11]) + Number(f[12])) / 100; };
  const cost = async (s) => { const begin = used(); await pause(s * 1000); return (used() - begin) / s; };
  const pairs = [];
  for (let i = 0; i < 3; ++i) {
    const alone = await cost(6);
    const feeds = Array.from({ length: 10 }, (_, i) => http.get(`${url}/events?robot=robots/${robot(i + 1)}`, { agent: false }, (a) => a.resume()));
    await pause(1000);
    pairs.push({ alone, watched: await cost(6) });
    for (const feed of feeds) feed.destroy();
    await pause(1000);
  }
  const { alone, watched } = pairs.sort((a, b) => a.watched - a.alone - (b.watched - b.alone))[1];
  check('ten consoles cost under 5 % of a core', watched - alone < 0.05, `${(100 * alone).toFixed(1)} % without, ${(100 * watched).toFixed(1)} % with them`);
  await visit('fleet', 'tbody tr');

  fleet.stop();
  await stop('SIGKILL');
  await page.waitForSelector('.link.bad');
  await start();
  const back = await until(() => page.waitForSelector('.link.good', { timeout: 100 }).then(() => true));
  check('a restart of the server is survived within 2 s', back < 2000, Math.round(back) + ' ms');
  await page.click('nav a[href="#/journeys"]');
  check('so are calls of the page', await page.waitForSelector('tbody tr', { timeout: 5000 }).then(() => true, () => false));

  const open = await ask('/api/v1/session');
  const csrf = JSON.parse(open.text).csrf;
  const list = { method: 'POST', body: '{}' };
  check('CSP', open.headers['content-security-policy']?.includes("script-src 'self'"));
  check('nosniff', open.headers['x-content-type-options'] === 'nosniff');
  check('CSRF', (await ask('/api/v1/FleetService/ListRobots', list)).status === 403);
  check('with the token', (await ask('/api/v1/FleetService/ListRobots', { ...list, headers: { 'X-CSRF-Token': csrf } })).status === 200);
  check('Host', (await ask('/api/v1/session', { headers: { Host: 'evil.example:80' } })).status === 403);
  check('Origin', (await ask('/api/v1/session', { headers: { Origin: 'http://evil.example' } })).status === 403);
  check('streams are not called', (await ask('/api/v1/HomingService/Localize', { ...list, headers: { 'X-CSRF-Token': csrf } })).status === 404);
  await stop();

  // With logins.
  const { execFileSync } = await import('node:child_process');
  rmSync(`${out}/homing.db`);
  for (const who of ['operators/anna', 'robots/r1']) execFileSync(server, ['token', who, '--tokens', `${out}/tokens`, '--out', `${out}/${who.split('/')[1]}.token`]);
  await start('--tokens', `${out}/tokens`);
  check('metrics without login', (await ask('/metrics')).status === 200);
  check('nothing else', (await ask('/events')).status === 401 && (await ask('/api/v1/session')).status === 401);
  const link = /login\?once=\S+/.exec(child.text)?.[0];
  check('a link at the first start', Boolean(link));
  const guest = await (await browser.newContext()).newPage();
  await guest.goto(url + '/' + link);
  await guest.click('button');
  check('it logs in', await guest.waitForSelector('a.brand').then(() => true));
  const [cookie] = await guest.context().cookies();
  check('the cookie', cookie?.httpOnly && cookie.sameSite === 'Strict');
  await guest.context().close();
  const second = await ask('/' + link, { method: 'POST', body: '' });
  check('it works once', second.headers.location === '/#/login?link=used' && !second.headers['set-cookie']);
  await page.goto(url + '/');
  await page.reload();
  await page.waitForSelector('#token');
  await shot('login', 'light');
  await page.fill('#token', 'wrong');
  await page.click('button.primary');
  check('a wrong token is refused', await page.waitForSelector('[role=alert]').then(() => true));
  await page.fill('#token', readFileSync(`${out}/r1.token`, 'utf8').trim());
  await page.click('button.primary');
  await page.waitForSelector('nav');
  const roles = await page.evaluate(async () => {
    const s = await (await fetch('/api/v1/session')).json();
    const post = (m, b) => fetch('/api/v1/' + m, { method: 'POST', headers: { 'X-CSRF-Token': s.csrf }, body: JSON.stringify(b) }).then((r) => r.status);
    return [s.role, await post('JourneyService/CreateJourney', { parent: 'robots/other', journeyId: 'j' }), await post('JourneyService/CreateJourney', { parent: 'robots/r1', journeyId: 'j' })];
  });
  check('the role is that of the token', roles.join() === 'robot,403,200', roles.join());
  await stop('SIGKILL');
  await start('--tokens', `${out}/tokens`);
  check('a restarted server asks for the login', await page.waitForSelector('#token', { timeout: 5000 }).then(() => true, () => false));
  await page.fill('#token', readFileSync(`${out}/r1.token`, 'utf8').trim());
  await page.click('button.primary');
  check('and is live after it', await page.waitForSelector('.link.good', { timeout: 5000 }).then(() => true, () => false));
  await page.click('text=Log out');
  check('log out', await page.waitForSelector('#token').then(() => true));
} catch (error) {
  check('the run', false, error.stack);
} finally {
  await browser.close();
  child?.kill('SIGKILL');
}
writeFileSync(`${out}/result`, failed ? 'FAILED\n' : 'ok\n');
console.log(failed ? 'console: FAILED' : 'console: in order');
process.exit(failed);
