// The arguments of one statement, in PostgreSQL's binary format. Not thread-safe.
#ifndef STORAGE_POSTGRES_PG_ARGUMENTS_H_
#define STORAGE_POSTGRES_PG_ARGUMENTS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace homing::storage::postgres {

// Each call adds the next argument, $1 first. An array becomes one argument of type bigint[] and
// the like.
class PgArguments {
 public:
  PgArguments& Integer(std::int64_t value);
  PgArguments& Real(double value);
  PgArguments& Text(const std::string& value);
  PgArguments& Integers(const std::vector<std::int64_t>& values);
  PgArguments& Texts(const std::vector<std::optional<std::string>>& values);
  PgArguments& Texts(const std::vector<std::string>& values);
  // Absent elements are NULL.
  PgArguments& Blobs(const std::vector<std::optional<std::string>>& values);

  int size() const { return static_cast<int>(values_.size()); }
  const std::vector<unsigned>& types() const { return types_; }
  const std::vector<std::string>& values() const { return values_; }

 private:
  PgArguments& Add(unsigned type, std::string value);

  std::vector<unsigned> types_;
  std::vector<std::string> values_;
};

// Most significant byte first.
void AppendBigEndian(std::uint64_t value, int bytes, std::string* text);
std::uint64_t ReadBigEndian(const char* bytes, int count);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_ARGUMENTS_H_
