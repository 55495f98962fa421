#include "client/bag/mcap_reader.h"

#include <algorithm>
#include <optional>
#include <string>

#include <zlib.h>

#include "absl/strings/str_cat.h"
#include "client/bag/byte_reader.h"
#include "client/bag/chunked_bag.h"
#include "client/bag/decompression.h"
#include "client/bag/mcap_format.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

// Opcode and length before each record.
constexpr std::uint64_t kHeadBytes = 9;
// Channel, sequence number and two times before a message's bytes.
constexpr std::uint64_t kMessageHeadBytes = 22;
// Upper bound of the bytes of a chunk before its records.
constexpr std::uint64_t kChunkHeadBytes = 256;

struct ChunkHead {
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  std::string compression;
  // From the record's first byte.
  std::uint64_t records_offset = 0;
  std::uint64_t records_size = 0;
};

Wire WireOf(std::string_view encoding) {
  if (encoding == "ros1") return Wire::kRos1;
  if (encoding == "cdr") return Wire::kCdr;
  return encoding == "protobuf" ? Wire::kProtobuf : Wire::kOther;
}

class McapReader : public ChunkedBag {
 public:
  McapReader(BagFile file, const BagLimits& limits) : ChunkedBag(std::move(file), limits) {}

  absl::Status Scan();
  absl::StatusOr<std::string> Read(const MessagePlace& place) override;

 protected:
  absl::StatusOr<std::string> LoadChunk(std::uint64_t offset) override;
  absl::Status ScanChunk(std::string_view records, std::uint64_t chunk, bool messages) override;

 private:
  absl::Status TakeRecord(std::uint8_t opcode, std::uint64_t offset, std::uint64_t size);
  absl::Status TakeSchema(std::string_view record);
  absl::Status TakeChannel(std::string_view record);
  absl::Status TakeIndex(std::string_view record);
  // Adds the message that begins at `offset` of the file, or of the chunk at `chunk`; reads only
  // its head.
  absl::Status TakeMessage(std::string_view head, std::int64_t chunk, std::uint64_t offset);
  absl::StatusOr<ChunkHead> ReadChunkHead(std::uint64_t offset) const;

  // Names by their numbers.
  std::map<std::uint16_t, std::string> schemas_;
};

absl::Status McapReader::TakeSchema(std::string_view record) {
  ByteReader reader(record);
  const auto id = reader.Take<std::uint16_t>();
  const std::string_view name = reader.Text();
  if (!reader.ok()) return absl::DataLossError("a schema ends too early");
  schemas_[id] = std::string(name);
  return absl::OkStatus();
}

absl::Status McapReader::TakeChannel(std::string_view record) {
  ByteReader reader(record);
  const auto id = reader.Take<std::uint16_t>();
  const auto schema = schemas_.find(reader.Take<std::uint16_t>());
  const std::string topic(reader.Text());
  const std::string_view encoding = reader.Text();
  if (!reader.ok()) return absl::DataLossError("a channel ends too early");
  const std::string type = schema == schemas_.end() ? "" : schema->second;
  SetChannel(id, AddTopic(topic, type, WireOf(encoding)));
  return absl::OkStatus();
}

absl::Status McapReader::TakeMessage(std::string_view head, std::int64_t chunk,
                                     std::uint64_t offset) {
  ByteReader reader(head);
  const auto channel = reader.Take<std::uint16_t>();
  reader.Take<std::uint32_t>();
  const auto time = reader.Take<std::uint64_t>();
  if (!reader.ok()) return absl::DataLossError("a message ends too early");
  AddMessage({static_cast<std::int64_t>(time), chunk, static_cast<std::int64_t>(offset), channel});
  return absl::OkStatus();
}

absl::Status McapReader::TakeIndex(std::string_view record) {
  ByteReader reader(record);
  const auto channel = reader.Take<std::uint16_t>();
  ByteReader entries(reader.Text());
  std::vector<MessagePlace> places;
  while (reader.ok() && !entries.empty() && entries.ok()) {
    MessagePlace place;
    place.time_ns = static_cast<std::int64_t>(entries.Take<std::uint64_t>());
    place.offset = static_cast<std::int64_t>(entries.Take<std::uint64_t>());
    places.push_back(place);
  }
  if (!reader.ok() || !entries.ok()) return absl::DataLossError("an index ends too early");
  AddIndex(channel, std::move(places));
  return absl::OkStatus();
}

absl::StatusOr<ChunkHead> McapReader::ReadChunkHead(std::uint64_t offset) const {
  HOMING_ASSIGN_OR_RETURN(const std::string bytes, file_.ReadUpTo(offset, kChunkHeadBytes));
  ByteReader reader(bytes);
  ChunkHead head;
  const auto opcode = reader.Take<std::uint8_t>();
  const auto record_size = reader.Take<std::uint64_t>();
  // First and last time of its messages.
  reader.Take<std::uint64_t>();
  reader.Take<std::uint64_t>();
  head.size = reader.Take<std::uint64_t>();
  head.crc = reader.Take<std::uint32_t>();
  head.compression = std::string(reader.Text());
  head.records_size = reader.Take<std::uint64_t>();
  head.records_offset = reader.offset();
  if (!reader.ok() || opcode != mcap_opcode::kChunk ||
      record_size < head.records_offset - kHeadBytes ||
      head.records_size > record_size - (head.records_offset - kHeadBytes)) {
    return absl::DataLossError("its header is damaged");
  }
  return head;
}

absl::StatusOr<std::string> McapReader::LoadChunk(std::uint64_t offset) {
  HOMING_ASSIGN_OR_RETURN(const ChunkHead head, ReadChunkHead(offset));
  if (head.size > limits_.max_chunk || head.records_size > limits_.max_chunk) {
    return absl::ResourceExhaustedError(absl::StrCat("it has ",
                                                     std::max(head.size, head.records_size),
                                                     " bytes; the limit is ", limits_.max_chunk));
  }
  HOMING_ASSIGN_OR_RETURN(const std::string bytes,
                          file_.Read(offset + head.records_offset, head.records_size));
  HOMING_ASSIGN_OR_RETURN(std::string records, Decompress(head.compression, bytes, head.size));
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size());
  if (head.crc != 0 && head.crc != crc) return absl::DataLossError("its checksum is wrong");
  return records;
}

absl::Status McapReader::ScanChunk(std::string_view records, std::uint64_t chunk, bool messages) {
  ByteReader reader(records);
  while (!reader.empty()) {
    const std::size_t offset = reader.offset();
    const auto opcode = reader.Take<std::uint8_t>();
    const std::string_view record = reader.Bytes(reader.Take<std::uint64_t>());
    if (!reader.ok()) return absl::DataLossError("a record ends too early");
    absl::Status status;
    if (opcode == mcap_opcode::kSchema) status = TakeSchema(record);
    if (opcode == mcap_opcode::kChannel) status = TakeChannel(record);
    if (opcode == mcap_opcode::kMessage && messages) {
      status = TakeMessage(record, static_cast<std::int64_t>(chunk), offset);
    }
    HOMING_RETURN_IF_ERROR(status);
  }
  return absl::OkStatus();
}

absl::Status McapReader::TakeRecord(std::uint8_t opcode, std::uint64_t offset, std::uint64_t size) {
  if (opcode == mcap_opcode::kChunk) BeginChunk(offset);
  if (opcode != mcap_opcode::kChunk && opcode != mcap_opcode::kMessageIndex)
    EndChunk(/*complete=*/true);
  const std::uint64_t content = offset + kHeadBytes;
  if (opcode == mcap_opcode::kMessage) {
    HOMING_ASSIGN_OR_RETURN(const std::string head,
                            file_.Read(content, std::min(size, kMessageHeadBytes)));
    return TakeMessage(head, -1, offset);
  }
  if (opcode != mcap_opcode::kSchema && opcode != mcap_opcode::kChannel &&
      opcode != mcap_opcode::kMessageIndex)
    return absl::OkStatus();
  HOMING_ASSIGN_OR_RETURN(const std::string record, file_.Read(content, size));
  if (opcode == mcap_opcode::kSchema) return TakeSchema(record);
  return opcode == mcap_opcode::kChannel ? TakeChannel(record) : TakeIndex(record);
}

absl::Status McapReader::Scan() {
  std::uint64_t offset = kMcapMagic.size();
  bool whole = false;
  while (!whole) {
    HOMING_ASSIGN_OR_RETURN(const std::string head, file_.ReadUpTo(offset, kHeadBytes));
    ByteReader reader(head);
    const auto opcode = reader.Take<std::uint8_t>();
    const auto size = reader.Take<std::uint64_t>();
    if (!reader.ok() || size > file_.size() - offset - kHeadBytes) break;
    whole = opcode == mcap_opcode::kDataEnd || opcode == mcap_opcode::kFooter;
    CheckPart("record", offset, TakeRecord(opcode, offset, size));
    offset += kHeadBytes + size;
  }
  EndChunk(/*complete=*/whole);
  EndScan(whole, offset);
  return absl::OkStatus();
}

absl::StatusOr<std::string> McapReader::Read(const MessagePlace& place) {
  const auto offset = static_cast<std::uint64_t>(place.offset);
  std::string from_file;
  std::string_view bytes;
  if (place.chunk < 0) {
    HOMING_ASSIGN_OR_RETURN(const std::string head, file_.Read(offset, kHeadBytes));
    ByteReader reader(std::string_view(head).substr(1));
    const auto size = reader.Take<std::uint64_t>();
    if (size > limits_.max_chunk) return absl::DataLossError("the message is too large");
    HOMING_ASSIGN_OR_RETURN(from_file, file_.Read(offset, kHeadBytes + size));
    bytes = from_file;
  } else {
    HOMING_ASSIGN_OR_RETURN(bytes, BytesInChunk(place));
  }
  ByteReader reader(bytes);
  const auto opcode = reader.Take<std::uint8_t>();
  ByteReader message(reader.Bytes(reader.Take<std::uint64_t>()));
  const auto channel = message.Take<std::uint16_t>();
  message.Bytes(kMessageHeadBytes - sizeof(channel));
  if (!reader.ok() || !message.ok() || opcode != mcap_opcode::kMessage ||
      channel != place.channel) {
    return absl::DataLossError("the index does not point to a message of its topic");
  }
  return std::string(message.Bytes(message.rest()));
}

}  // namespace

absl::StatusOr<std::unique_ptr<Bag>> OpenMcap(BagFile file, const BagLimits& limits) {
  auto reader = std::make_unique<McapReader>(std::move(file), limits);
  HOMING_RETURN_IF_ERROR(reader->Scan());
  return reader;
}

}  // namespace homing::client::bag
