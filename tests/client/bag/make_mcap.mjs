// Writes MCAP files for the tests: node make_mcap.mjs FOLDER NODE_MODULES. Needs @mcap/core and
// @foxglove/cdr from npm, and the programs zstd and lz4.
//
// The frames are those of make_ros1.py, as messages of ROS 2, of ROS 1, or of Foxglove (PNG).
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { deflateSync } from "node:zlib";

const [folder, modules] = process.argv.slice(2);
const require = createRequire(modules + "/");
const { McapWriter } = require("@mcap/core");
const { CdrWriter } = require("@foxglove/cdr");

const kStart = 1000n * 1000000000n;
const stamp = (frame) => ({ sec: 1000, nsec: frame * 100000000 });
const pixels = (frame, right) =>
  Uint8Array.from({ length: 48 }, (_, i) => (right ? 200 - frame - i : frame + i));

function header(writer, frame) {
  writer.int32(stamp(frame).sec);
  writer.uint32(stamp(frame).nsec);
  writer.string("camera");
}

function cdrImage(frame, right) {
  const writer = new CdrWriter();
  header(writer, frame);
  writer.uint32(6).uint32(8).string("mono8").uint8(0).uint32(8);
  writer.uint8Array(pixels(frame, right), true);
  return writer.data;
}

function cdrCamera() {
  const writer = new CdrWriter();
  header(writer, 0);
  writer.uint32(6).uint32(8).string("plumb_bob");
  writer.float64Array([-0.25, 0.0625, 0, 0, 0], true);
  writer.float64Array([7, 0, 4, 0, 7.5, 3, 0, 0, 1]);
  writer.float64Array([1, 0, 0, 0, 1, 0, 0, 0, 1]);
  writer.float64Array([6, 0, 4, 0, 0, 6, 3, 0, 0, 0, 1, 0]);
  return writer.data;
}

function ros1Image(frame, right) {
  const number = (value) => {
    const bytes = Buffer.alloc(4);
    bytes.writeUInt32LE(value);
    return bytes;
  };
  const text = (value) => Buffer.concat([number(value.length), Buffer.from(value)]);
  const { sec, nsec } = stamp(frame);
  return Buffer.concat([
    number(frame), number(sec), number(nsec), text("camera"), number(6), number(8), text("mono8"),
    Buffer.from([0]), number(8), number(48), pixels(frame, right),
  ]);
}

function png(frame, right) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const out = Buffer.alloc(8 + body.length);
    out.writeUInt32BE(data.length);
    body.copy(out, 4);
    out.writeUInt32BE(crc(body), 4 + body.length);
    return out;
  };
  const head = Buffer.from([0, 0, 0, 8, 0, 0, 0, 6, 8, 0, 0, 0, 0]);
  const rows = Buffer.concat(
    Array.from({ length: 6 }, (_, y) =>
      Buffer.concat([Buffer.from([0]), pixels(frame, right).subarray(8 * y, 8 * y + 8)])),
  );
  return Buffer.concat([
    Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), chunk("IHDR", head), chunk("IDAT", deflateSync(rows)),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

function crc(bytes) {
  let sum = 0xffffffff;
  for (const byte of bytes) {
    sum ^= byte;
    for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return (sum ^ 0xffffffff) >>> 0;
}

// foxglove.CompressedImage: a stamp (1), data (2) and a format (3).
function protobufImage(frame, right) {
  const varint = (value) => {
    const bytes = [];
    for (; value > 127; value = Math.floor(value / 128)) bytes.push((value % 128) + 128);
    return Buffer.from([...bytes, value]);
  };
  const bytesField = (number, data) =>
    Buffer.concat([varint(number * 8 + 2), varint(data.length), data]);
  const { sec, nsec } = stamp(frame);
  const time = Buffer.concat([varint(8), varint(sec), varint(16), varint(nsec)]);
  return Buffer.concat([
    bytesField(1, time), bytesField(2, png(frame, right)), bytesField(3, Buffer.from("png")),
  ]);
}

const kinds = {
  cdr: { encoding: "cdr", schema: "sensor_msgs/msg/Image", language: "ros2msg", image: cdrImage },
  ros1: { encoding: "ros1", schema: "sensor_msgs/Image", language: "ros1msg", image: ros1Image },
  protobuf: {
    encoding: "protobuf", schema: "foxglove.CompressedImage", language: "protobuf", image: protobufImage,
  },
};

const compressors = {
  none: undefined,
  zstd: (data) => ({
    compression: "zstd", compressedData: execFileSync("zstd", ["-c", "-q"], { input: data }),
  }),
  lz4: (data) => ({
    compression: "lz4", compressedData: execFileSync("lz4", ["-c", "-q"], { input: data }),
  }),
};

class Memory {
  parts = [];
  length = 0n;
  async write(bytes) {
    this.parts.push(Buffer.from(bytes));
    this.length += BigInt(bytes.length);
  }
  position() {
    return this.length;
  }
}

async function write(name, kind, compression, options) {
  const memory = new Memory();
  const writer = new McapWriter({
    writable: memory, chunkSize: 500, compressChunk: compressors[compression], ...options,
  });
  await writer.start({ profile: kind.encoding === "cdr" ? "ros2" : "", library: "test" });
  const schema = (name) =>
    writer.registerSchema({ name, encoding: kind.language, data: Buffer.from("") });
  const channel = async (topic, schemaId) =>
    writer.registerChannel({
      topic, schemaId, messageEncoding: kind.encoding, metadata: new Map(),
    });
  const add = (channelId, frame, data) => {
    const logTime = kStart + BigInt(frame) * 100000000n + 7n;
    return writer.addMessage({ channelId, sequence: frame, logTime, publishTime: logTime, data });
  };
  const images = await schema(kind.schema);
  const left = await channel("/cam/left/image_raw", images);
  const right = await channel("/cam/right/image_raw", images);
  if (kind.encoding === "cdr") {
    const info = await channel("/cam/left/camera_info", await schema("sensor_msgs/msg/CameraInfo"));
    await add(info, 0, cdrCamera());
  }
  for (let frame = 0; frame < 12; ++frame) {
    await add(left, frame, kind.image(frame, false));
    await add(right, frame, kind.image(frame, true));
  }
  await writer.end();
  writeFileSync(`${folder}/${name}.mcap`, Buffer.concat(memory.parts));
}

for (const compression of Object.keys(compressors)) await write(compression, kinds.cdr, compression, {});
await write("no_index", kinds.cdr, "zstd", {
  useMessageIndex: false, useStatistics: false, useChunkIndex: false, useSummaryOffsets: false,
  repeatChannels: false, repeatSchemas: false,
});
await write("no_summary_channels", kinds.cdr, "lz4", { repeatChannels: false, repeatSchemas: false });
await write("no_chunks", kinds.cdr, "none", { useChunks: false });
await write("ros1", kinds.ros1, "none", {});
await write("foxglove", kinds.protobuf, "zstd", {});
