// Writes MCAP files of Protobuf messages. Source: the format's public specification
// (mcap.dev/spec).
#ifndef CLIENT_BAG_MCAP_WRITER_H_
#define CLIENT_BAG_MCAP_WRITER_H_

#include <google/protobuf/message.h>

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace homing::client::bag {

// Chunks of about a megabyte, compressed by zstd and indexed. After a crash all but the last chunk
// can be read. Not thread-safe.
class McapWriter {
 public:
  // REQUIRES: `file` outlives the writer.
  explicit McapWriter(std::ostream* file);

  // Also writes the definition of the messages' type, with the types that it uses.
  std::uint16_t AddChannel(const std::string& topic, const google::protobuf::Descriptor* type);
  // RESOURCE_EXHAUSTED: cannot write.
  absl::Status Write(std::uint16_t channel, std::int64_t time_ns,
                     const google::protobuf::Message& message);
  // The last chunk, then the index of all. Once, at the end. RESOURCE_EXHAUSTED.
  absl::Status Finish();

 private:
  using IndexEntry = std::pair<std::int64_t, std::uint64_t>;
  struct Span {
    std::int64_t first = 0;
    std::int64_t last = 0;
    void Add(std::int64_t time_ns, bool only);
  };

  std::uint16_t AddSchema(const google::protobuf::Descriptor* type);
  void Put(const std::string& bytes);
  void PutChunk();
  std::string Statistics() const;

  std::ostream* file_;
  std::uint64_t offset_ = 0;
  // Records that are written both into the chunk and into the summary.
  std::string schemas_;
  std::string channels_;
  std::string chunk_indexes_;
  std::map<std::string, std::uint16_t> schema_ids_;
  std::uint16_t channel_count_ = 0;
  std::uint32_t chunk_count_ = 0;
  std::map<std::uint16_t, std::uint64_t> message_counts_;
  Span all_;
  // The chunk that is being filled.
  std::string chunk_;
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;
  Span span_;
};

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_MCAP_WRITER_H_
