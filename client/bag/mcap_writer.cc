#include "client/bag/mcap_writer.h"

#include <google/protobuf/descriptor.pb.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <concepts>
#include <set>

#include "client/bag/mcap_format.h"

namespace homing::client::bag {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;
// Appends in MCAP's form: little endian, texts behind a length of four bytes.
class McapFields {
 public:
  template <std::integral Number>
  McapFields& Add(Number number) {
    for (std::size_t byte = 0; byte < sizeof(Number); ++byte) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * byte)));
    }
    return *this;
  }
  McapFields& Text(const std::string& text) {
    Add(static_cast<std::uint32_t>(text.size()));
    return Raw(text);
  }
  McapFields& Raw(const std::string& bytes) {
    bytes_ += bytes;
    return *this;
  }
  std::string bytes() const { return bytes_; }
  std::string Record(std::uint8_t opcode) const {
    return McapFields().Add(opcode).Add(std::uint64_t{bytes_.size()}).Raw(bytes_).bytes_;
  }

 private:
  std::string bytes_;
};

// Adds the file and those that it imports, each after its own imports.
void AddFile(const google::protobuf::FileDescriptor* file, std::set<std::string>* known,
             google::protobuf::FileDescriptorSet* files) {
  if (!known->insert(file->name()).second) return;
  for (int i = 0; i < file->dependency_count(); ++i) AddFile(file->dependency(i), known, files);
  file->CopyTo(files->add_file());
}

std::string CompressZstd(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1);
  // Compression fails only when memory runs out; readers then detect the empty chunk by its
  // checksum.
  out.resize(ZSTD_isError(size) != 0U ? 0 : size);
  return out;
}

}  // namespace

void McapWriter::Span::Add(std::int64_t time_ns, bool only) {
  first = only ? time_ns : std::min(first, time_ns);
  last = only ? time_ns : std::max(last, time_ns);
}

McapWriter::McapWriter(std::ostream* file) : file_(file) {
  Put(std::string(kMcapMagic));
  Put(McapFields().Text("").Text("homing").Record(mcap_opcode::kHeader));
}

void McapWriter::Put(const std::string& bytes) {
  file_->write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  offset_ += bytes.size();
}

std::uint16_t McapWriter::AddSchema(const google::protobuf::Descriptor* type) {
  const auto [known, added] = schema_ids_.try_emplace(
      type->full_name(), static_cast<std::uint16_t>(schema_ids_.size() + 1));
  if (!added) return known->second;
  google::protobuf::FileDescriptorSet files;
  std::set<std::string> names;
  AddFile(type->file(), &names, &files);
  const std::string record = McapFields()
                                 .Add(known->second)
                                 .Text(type->full_name())
                                 .Text("protobuf")
                                 .Text(files.SerializeAsString())
                                 .Record(mcap_opcode::kSchema);
  chunk_ += record;
  schemas_ += record;
  return known->second;
}

std::uint16_t McapWriter::AddChannel(const std::string& topic,
                                     const google::protobuf::Descriptor* type) {
  const std::uint16_t schema = AddSchema(type);
  const std::uint16_t channel = ++channel_count_;
  // The last text is the empty map of metadata.
  const std::string record = McapFields()
                                 .Add(channel)
                                 .Add(schema)
                                 .Text(topic)
                                 .Text("protobuf")
                                 .Text("")
                                 .Record(mcap_opcode::kChannel);
  chunk_ += record;
  channels_ += record;
  return channel;
}

absl::Status McapWriter::Write(std::uint16_t channel, std::int64_t time_ns,
                               const google::protobuf::Message& message) {
  span_.Add(time_ns, index_.empty());
  all_.Add(time_ns, message_counts_.empty());
  const auto sequence = static_cast<std::uint32_t>(message_counts_[channel]++);
  index_[channel].emplace_back(time_ns, chunk_.size());
  chunk_ += McapFields()
                .Add(channel)
                .Add(sequence)
                .Add(time_ns)
                .Add(time_ns)
                .Raw(message.SerializeAsString())
                .Record(mcap_opcode::kMessage);
  if (chunk_.size() >= kChunkBytes) PutChunk();
  if (file_->good()) return absl::OkStatus();
  return absl::ResourceExhaustedError("cannot write the MCAP file");
}

void McapWriter::PutChunk() {
  if (chunk_.empty()) return;
  const std::uint64_t start = offset_;
  const std::string packed = CompressZstd(chunk_);
  const auto crc = static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(chunk_.data()), chunk_.size()));
  Put(McapFields()
          .Add(span_.first)
          .Add(span_.last)
          .Add(std::uint64_t{chunk_.size()})
          .Add(crc)
          .Text("zstd")
          .Add(std::uint64_t{packed.size()})
          .Raw(packed)
          .Record(mcap_opcode::kChunk));
  const std::uint64_t indexes_start = offset_;
  McapFields offsets;
  for (const auto& [channel, entries] : index_) {
    offsets.Add(channel).Add(offset_);
    McapFields list;
    for (const auto& [time, offset] : entries) list.Add(time).Add(offset);
    Put(McapFields().Add(channel).Text(list.bytes()).Record(mcap_opcode::kMessageIndex));
  }
  chunk_indexes_ += McapFields()
                        .Add(span_.first)
                        .Add(span_.last)
                        .Add(start)
                        .Add(indexes_start - start)
                        .Text(offsets.bytes())
                        .Add(offset_ - indexes_start)
                        .Text("zstd")
                        .Add(std::uint64_t{packed.size()})
                        .Add(std::uint64_t{chunk_.size()})
                        .Record(mcap_opcode::kChunkIndex);
  ++chunk_count_;
  chunk_.clear();
  index_.clear();
  span_ = {};
}

std::string McapWriter::Statistics() const {
  std::uint64_t messages = 0;
  McapFields counts;
  for (const auto& [channel, count] : message_counts_) {
    counts.Add(channel).Add(count);
    messages += count;
  }
  return McapFields()
      .Add(messages)
      .Add(static_cast<std::uint16_t>(schema_ids_.size()))
      .Add(std::uint32_t{channel_count_})
      .Add(std::uint32_t{0})  // attachments
      .Add(std::uint32_t{0})  // metadata
      .Add(chunk_count_)
      .Add(all_.first)
      .Add(all_.last)
      .Text(counts.bytes())
      .Record(mcap_opcode::kStatistics);
}

absl::Status McapWriter::Finish() {
  PutChunk();
  // No checksums: 0.
  Put(McapFields().Add(std::uint32_t{0}).Record(mcap_opcode::kDataEnd));
  const std::uint64_t summary = offset_;
  Put(schemas_ + channels_ + Statistics() + chunk_indexes_);
  Put(McapFields()
          .Add(summary)
          .Add(std::uint64_t{0})
          .Add(std::uint32_t{0})
          .Record(mcap_opcode::kFooter));
  Put(std::string(kMcapMagic));
  file_->flush();
  if (file_->good()) return absl::OkStatus();
  return absl::ResourceExhaustedError("cannot write the MCAP file");
}

}  // namespace homing::client::bag
