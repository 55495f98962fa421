// A simulated fleet: robots record and localise with flow vectors of landmarks at random heights.
import grpc from '@grpc/grpc-js';
import loader from '@grpc/proto-loader';

const width = 160, height = 120, places = 20;

// Of integers, 0..1.
function noise(a, b, c = 0) {
  let h = (Math.imul(a, 0x9e3779b1) + Math.imul(b, 0x85ebca77) + Math.imul(c, 0xc2b2ae3d)) >>> 0;
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d) >>> 0;
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39) >>> 0;
  return ((h ^ (h >>> 15)) >>> 0) / 4294967296;
}
function view(place, side) {
  const landmark = Math.floor(place / places) * 2 + side;
  const x = width * (0.7 - (0.4 * (place % places)) / places);
  const y = height * (0.25 + 0.5 * noise(landmark, 1));
  const flow = { width, height, startX: [], startY: [], endX: [], endY: [] };
  for (let n = 20 + Math.floor(60 * noise(landmark, 2)); n > 0; --n) {
    const sx = x + 20 * (noise(landmark, n, 3) - 0.5), sy = y + 20 * (noise(landmark, n, 4) - 0.5);
    flow.startX.push(sx); flow.startY.push(sy);
    flow.endX.push(sx - 2 - noise(landmark, n, 5)); flow.endY.push(sy);
  }
  return { flowVectors: flow };
}
const observation = (sequence, place) => ({ observation: { sequence, left: view(place, 0), right: view(place, 1) } });

export class Fleet {
  constructor(address, protos, token) {
    const load = (file) => grpc.loadPackageDefinition(loader.loadSync(`homing/v1/${file}.proto`, { includeDirs: [protos], longs: Number, enums: String })).homing.v1;
    const credentials = grpc.credentials.createInsecure();
    this.journeys = new (load('journey_service').JourneyService)(address, credentials);
    this.homing = new (load('homing_service').HomingService)(address, credentials);
    this.meta = new grpc.Metadata();
    if (token) this.meta.set('authorization', 'Bearer ' + token);
    this.robots = new Map();
  }
  create(robot, journey) {
    return new Promise((done, fail) => this.journeys.createJourney({ parent: 'robots/' + robot, journeyId: journey, journey: { readers: ['*'] } }, this.meta, (e, made) => (e ? fail(e) : done(made))));
  }
  record(robot, journey, steps) {
    return new Promise((done, fail) => {
      const stream = this.journeys.recordJourney(this.meta);
      stream.on('data', () => {}).on('end', done).on('error', fail);
      stream.write({ config: { journey: `robots/${robot}/journeys/${journey}`, writerId: 'w' } });
      for (let i = 0; i < steps; ++i) stream.write(observation(i, i));
      stream.end();
    });
  }
  // Drives home along `journey` at `hz`; lose(name) carries the robot to where nothing is known.
  drive(name, journey, steps, hz, from) {
    const state = { place: from, sequence: 0, lost: false };
    const stream = this.homing.localize(this.meta);
    stream.on('data', (answer) => { state.answer = answer; }).on('error', () => clearInterval(state.timer));
    stream.write({ config: { journey, travel: 'TRAVEL_SAME', robot: 'robots/' + name } });
    const next = () => {
      state.place = state.lost ? state.place + 37 : (state.place + 1) % steps;
      stream.write(observation(state.sequence++, state.place));
    };
    state.timer = setInterval(next, 1000 / hz);
    state.lose = () => { state.lost = true; state.place = 5000; };
    state.burst = (n) => { for (let i = 0; i < n; ++i) next(); };
    state.stream = stream;
    this.robots.set(name, state);
    return state;
  }
  stop() {
    for (const state of this.robots.values()) { clearInterval(state.timer); state.stream.cancel(); }
    this.journeys.close(); this.homing.close();
  }
}
