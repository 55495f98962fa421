#include "client/bag/ros1_bag.h"

#include <algorithm>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/bag/byte_reader.h"
#include "client/bag/chunked_bag.h"
#include "client/bag/decompression.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

// Values of the field "op".
constexpr std::uint8_t kMessageData = 0x02;
constexpr std::uint8_t kBagHeader = 0x03;
constexpr std::uint8_t kIndexData = 0x04;
constexpr std::uint8_t kChunkRecord = 0x05;
constexpr std::uint8_t kConnection = 0x07;

constexpr std::uint64_t kMaxHeaderBytes = 1 << 20;

// NAME=VALUE pairs, each after its length; views of the record's header.
class Fields {
 public:
  explicit Fields(std::string_view header) {
    ByteReader reader(header);
    while (!reader.empty() && reader.ok()) {
      const std::string_view field = reader.Text();
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) continue;
      values_.emplace(field.substr(0, equals), field.substr(equals + 1));
    }
  }

  std::string_view Text(std::string_view name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::string_view() : found->second;
  }
  // 0 where there is none.
  template <typename Number>
  Number As(std::string_view name) const {
    return ByteReader(Text(name)).Take<Number>();
  }
  bool Has(std::string_view name) const { return values_.contains(name); }

 private:
  std::map<std::string_view, std::string_view> values_;
};

std::int64_t TakeTime(ByteReader& reader) {
  const auto seconds = reader.Take<std::uint32_t>();
  const auto nanoseconds = reader.Take<std::uint32_t>();
  return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
}

// A record of the file: its header, and where its data lies.
struct RecordHead {
  std::string header;
  std::uint64_t data_offset = 0;
  std::uint64_t data_size = 0;
};

class Ros1Bag : public ChunkedBag {
 public:
  Ros1Bag(BagFile file, const BagLimits& limits) : ChunkedBag(std::move(file), limits) {}

  absl::Status Scan();
  absl::StatusOr<std::string> Read(const MessagePlace& place) override;

 protected:
  absl::StatusOr<std::string> LoadChunk(std::uint64_t offset) override;
  absl::Status ScanChunk(std::string_view records, std::uint64_t chunk, bool messages) override;

 private:
  absl::StatusOr<RecordHead> ReadHead(std::uint64_t offset) const;
  absl::Status TakeRecord(const RecordHead& head, std::uint64_t offset);
  // Reports a bag that was not closed, or ends before its index.
  void TakeBagHeader(const Fields& fields);
  void TakeConnection(const Fields& fields, std::string_view data);
  absl::Status TakeIndex(const Fields& fields, std::string_view data);
  void TakeMessage(const Fields& fields, std::int64_t chunk, std::uint64_t offset);
};

absl::StatusOr<RecordHead> Ros1Bag::ReadHead(std::uint64_t offset) const {
  constexpr std::uint64_t kLength = sizeof(std::uint32_t);
  HOMING_ASSIGN_OR_RETURN(const std::string first, file_.Read(offset, kLength));
  const std::uint64_t header_size = ByteReader(first).Take<std::uint32_t>();
  if (header_size > kMaxHeaderBytes) return absl::DataLossError("its header is too long");
  HOMING_ASSIGN_OR_RETURN(std::string header, file_.Read(offset + kLength, header_size + kLength));
  const std::string_view data_size = std::string_view(header).substr(header_size);
  RecordHead head;
  head.data_size = ByteReader(data_size).Take<std::uint32_t>();
  head.data_offset = offset + kLength + header_size + kLength;
  if (head.data_size > file_.size() - head.data_offset) {
    return absl::DataLossError("it ends beyond the end of the file");
  }
  header.resize(header_size);
  head.header = std::move(header);
  return head;
}

void Ros1Bag::TakeBagHeader(const Fields& fields) {
  const auto index = fields.As<std::uint64_t>("index_pos");
  if (index == 0) ReportDamage(file_.path() + " was not closed; its end may be missing");
  if (index > file_.size()) {
    ReportDamage(absl::StrCat(file_.path(), " ends too early: it has ", file_.size(),
                              " bytes, its index begins at ", index));
  }
}

void Ros1Bag::TakeConnection(const Fields& fields, std::string_view data) {
  const Fields about(data);
  const std::string topic(fields.Text("topic"));
  SetChannel(fields.As<std::uint32_t>("conn"),
             AddTopic(topic, std::string(about.Text("type")), Wire::kRos1));
}

absl::Status Ros1Bag::TakeIndex(const Fields& fields, std::string_view data) {
  ByteReader reader(data);
  std::vector<MessagePlace> places;
  while (!reader.empty() && reader.ok()) {
    MessagePlace place;
    place.time_ns = TakeTime(reader);
    place.offset = reader.Take<std::uint32_t>();
    places.push_back(place);
  }
  if (!reader.ok()) return absl::DataLossError("an index ends too early");
  AddIndex(fields.As<std::uint32_t>("conn"), std::move(places));
  return absl::OkStatus();
}

void Ros1Bag::TakeMessage(const Fields& fields, std::int64_t chunk, std::uint64_t offset) {
  ByteReader time(fields.Text("time"));
  AddMessage(
      {TakeTime(time), chunk, static_cast<std::int64_t>(offset), fields.As<std::uint32_t>("conn")});
}

absl::StatusOr<std::string> Ros1Bag::LoadChunk(std::uint64_t offset) {
  HOMING_ASSIGN_OR_RETURN(const RecordHead head, ReadHead(offset));
  const Fields fields(head.header);
  const std::uint64_t size = fields.As<std::uint32_t>("size");
  if (size > limits_.max_chunk || head.data_size > limits_.max_chunk) {
    return absl::ResourceExhaustedError(absl::StrCat("it has ", std::max(size, head.data_size),
                                                     " bytes; the limit is ", limits_.max_chunk));
  }
  HOMING_ASSIGN_OR_RETURN(const std::string bytes, file_.Read(head.data_offset, head.data_size));
  return Decompress(fields.Text("compression"), bytes, size);
}

absl::Status Ros1Bag::ScanChunk(std::string_view records, std::uint64_t chunk, bool messages) {
  ByteReader reader(records);
  while (!reader.empty()) {
    const std::size_t offset = reader.offset();
    const Fields fields(reader.Text());
    const std::string_view data = reader.Text();
    if (!reader.ok()) return absl::DataLossError("a record ends too early");
    const auto op = fields.As<std::uint8_t>("op");
    if (op == kConnection) TakeConnection(fields, data);
    if (op == kMessageData && messages) {
      TakeMessage(fields, static_cast<std::int64_t>(chunk), offset);
    }
  }
  return absl::OkStatus();
}

absl::Status Ros1Bag::TakeRecord(const RecordHead& head, std::uint64_t offset) {
  const Fields fields(head.header);
  const auto op = fields.As<std::uint8_t>("op");
  if (op == kChunkRecord) BeginChunk(offset);
  if (op != kChunkRecord && op != kIndexData) EndChunk(/*complete=*/true);
  if (op == kBagHeader) TakeBagHeader(fields);
  if (op == kMessageData) TakeMessage(fields, -1, offset);
  if (op != kConnection && op != kIndexData) return absl::OkStatus();
  HOMING_ASSIGN_OR_RETURN(const std::string data, file_.Read(head.data_offset, head.data_size));
  if (op == kIndexData) return TakeIndex(fields, data);
  TakeConnection(fields, data);
  return absl::OkStatus();
}

absl::Status Ros1Bag::Scan() {
  std::uint64_t offset = kRos1Magic.size();
  while (offset < file_.size()) {
    const auto head = ReadHead(offset);
    if (!head.ok()) break;
    CheckPart("record", offset, TakeRecord(*head, offset));
    offset = head->data_offset + head->data_size;
  }
  EndChunk(/*complete=*/false);
  EndScan(/*whole=*/offset >= file_.size(), offset);
  return absl::OkStatus();
}

absl::StatusOr<std::string> Ros1Bag::Read(const MessagePlace& place) {
  const auto offset = static_cast<std::uint64_t>(place.offset);
  if (place.chunk < 0) {
    HOMING_ASSIGN_OR_RETURN(const RecordHead head, ReadHead(offset));
    if (head.data_size > limits_.max_chunk) return absl::DataLossError("the message is too large");
    return file_.Read(head.data_offset, head.data_size);
  }
  HOMING_ASSIGN_OR_RETURN(const std::string_view bytes, BytesInChunk(place));
  ByteReader reader(bytes);
  const Fields fields(reader.Text());
  const std::string_view data = reader.Text();
  if (!reader.ok() || fields.As<std::uint8_t>("op") != kMessageData ||
      fields.As<std::uint32_t>("conn") != place.channel) {
    return absl::DataLossError("the index does not point to a message of its topic");
  }
  return std::string(data);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Bag>> OpenRos1Bag(BagFile file, const BagLimits& limits) {
  auto bag = std::make_unique<Ros1Bag>(std::move(file), limits);
  HOMING_RETURN_IF_ERROR(bag->Scan());
  return bag;
}

}  // namespace homing::client::bag
