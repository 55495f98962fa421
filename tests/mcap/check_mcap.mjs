// Reads an MCAP file of homing localize --mcap-out with @mcap/core, by its index and from beginning
// to end, and prints what is in it: node check_mcap.mjs FILE NODE_MODULES. Needs @mcap/core and
// protobufjs from npm, and the program zstd.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const [file, modules] = process.argv.slice(2);
const require = createRequire(modules + "/");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const protobuf = require("protobufjs");
const { FileDescriptorSet } = require("protobufjs/ext/descriptor");

const bytes = readFileSync(file);
const decompressHandlers = {
  zstd: (data, size) => {
    const out = execFileSync("zstd", ["-d", "-c", "-q"], { input: data, maxBuffer: 1 << 28 });
    if (BigInt(out.length) !== size) throw new Error("another size than the chunk says");
    return out;
  },
};

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
if (!stream.done()) throw new Error("the file does not end as it should");

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) =>
    new Uint8Array(bytes.subarray(Number(offset), Number(offset) + Number(size))),
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const types = new Map();
for (const [id, schema] of reader.schemasById) {
  const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data));
  types.set(id, root.lookupType(schema.name));
}
const topics = {};
let indexed = 0;
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const value = types.get(channel.schemaId).decode(message.data);
  const topic = (topics[channel.topic] ??= {
    schema: reader.schemasById.get(channel.schemaId).name, messages: 0,
  });
  ++topic.messages;
  if (value.points) topic.points = (topic.points ?? 0) + (value.points[0]?.points.length ?? 0);
  if (value.circles) topic.circles = (topic.circles ?? 0) + value.circles.length;
  if (value.texts) topic.text = value.texts.at(-1)?.text;
  ++indexed;
}
const counted = Number(reader.statistics.messageCount);
if (indexed !== streamed || counted !== streamed) {
  throw new Error(`${streamed} messages, ${indexed} by the index, ${counted} by the statistics`);
}
console.log(JSON.stringify(topics, null, 1));
