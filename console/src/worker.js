// Shared by all tabs: a browser opens six connections to one host, so that each tab cannot have its own.
import { createFeed } from './feed.js';

const ports = new Map();
const feed = createFeed((message) => { for (const port of ports.keys()) port.postMessage(message); });
const update = () => {
  if (ports.size === 0) feed.close();
  else feed.watch([...ports.values()].filter(Boolean));
};
self.onconnect = (event) => {
  const port = event.ports[0];
  ports.set(port, '');
  port.onmessage = ({ data }) => {
    if (data.bye) ports.delete(port);
    else ports.set(port, data.robot ?? '');
    update();
  };
  port.postMessage({ kind: 'fleet', robots: feed.all(), whole: true, cached: true });
  update();
};
