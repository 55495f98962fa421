// The server's events: the whole fleet, and the robots that pages show. One EventSource, opened again
// when the set of robots changes.
export function createFeed(deliver) {
  let source = null;
  let url = '';
  let timer = 0;
  const fleet = new Map();
  function open() {
    source?.close();
    source = new EventSource(url);
    let whole = true;
    source.onopen = () => { whole = true; deliver({ kind: 'link', up: true }); };
    source.addEventListener('fleet', (event) => {
      const robots = JSON.parse(event.data).robots ?? [];
      // The first message after a (re)start holds all robots.
      if (whole) fleet.clear();
      for (const robot of robots) fleet.set(robot.name, robot);
      deliver({ kind: 'fleet', robots, whole });
      whole = false;
    });
    source.addEventListener('robot', (event) => deliver({ kind: 'robot', update: JSON.parse(event.data) }));
    source.onerror = () => {
      deliver({ kind: 'link', up: false });
      // A refusal closes it for good: try again, gently.
      if (source.readyState === EventSource.CLOSED) {
        deliver({ kind: 'refused' });
        clearTimeout(timer);
        timer = setTimeout(open, 1500);
      }
    };
  }
  return {
    watch(robots) {
      const names = [...new Set(robots)].sort().slice(0, 8);
      const wanted = '/events' + (names.length ? '?' + names.map((n) => 'robot=' + encodeURIComponent(n)).join('&') : '');
      if (wanted === url) return;
      url = wanted;
      clearTimeout(timer);
      open();
    },
    all: () => [...fleet.values()],
    close() { clearTimeout(timer); source?.close(); url = ''; },
  };
}
