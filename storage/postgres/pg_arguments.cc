#include "storage/postgres/pg_arguments.h"

#include <bit>
#include <utility>

namespace homing::storage::postgres {
namespace {

// Numbers of types: the file pg_type.dat of PostgreSQL. They never change.
constexpr unsigned kBytea = 17;
constexpr unsigned kBigint = 20;
constexpr unsigned kText = 25;
constexpr unsigned kDouble = 701;
constexpr unsigned kByteaArray = 1001;
constexpr unsigned kTextArray = 1009;
constexpr unsigned kBigintArray = 1016;

constexpr std::uint32_t kNull = 0xffffffff;

// The head of an array of one dimension, or of an empty one.
std::string ArrayHead(unsigned element, std::size_t size) {
  std::string array;
  AppendBigEndian(size == 0 ? 0 : 1, 4, &array);
  // Elements may be NULL.
  AppendBigEndian(1, 4, &array);
  AppendBigEndian(element, 4, &array);
  if (size > 0) {
    AppendBigEndian(size, 4, &array);
    AppendBigEndian(1, 4, &array);
  }
  return array;
}

std::string TextArray(unsigned element, const std::vector<std::optional<std::string>>& values) {
  std::string array = ArrayHead(element, values.size());
  for (const std::optional<std::string>& value : values) {
    AppendBigEndian(value ? value->size() : kNull, 4, &array);
    if (value) array += *value;
  }
  return array;
}

}  // namespace

void AppendBigEndian(std::uint64_t value, int bytes, std::string* text) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    text->push_back(static_cast<char>(value >> shift & 0xff));
  }
}

std::uint64_t ReadBigEndian(const char* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
  return value;
}

PgArguments& PgArguments::Add(unsigned type, std::string value) {
  types_.push_back(type);
  values_.push_back(std::move(value));
  return *this;
}

PgArguments& PgArguments::Integer(std::int64_t value) {
  std::string bytes;
  AppendBigEndian(static_cast<std::uint64_t>(value), 8, &bytes);
  return Add(kBigint, std::move(bytes));
}

PgArguments& PgArguments::Real(double value) {
  std::string bytes;
  AppendBigEndian(std::bit_cast<std::uint64_t>(value), 8, &bytes);
  return Add(kDouble, std::move(bytes));
}

PgArguments& PgArguments::Text(const std::string& value) { return Add(kText, value); }

PgArguments& PgArguments::Integers(const std::vector<std::int64_t>& values) {
  std::string array = ArrayHead(kBigint, values.size());
  for (const std::int64_t value : values) {
    AppendBigEndian(8, 4, &array);
    AppendBigEndian(static_cast<std::uint64_t>(value), 8, &array);
  }
  return Add(kBigintArray, std::move(array));
}

PgArguments& PgArguments::Texts(const std::vector<std::optional<std::string>>& values) {
  return Add(kTextArray, TextArray(kText, values));
}

PgArguments& PgArguments::Texts(const std::vector<std::string>& values) {
  return Texts(std::vector<std::optional<std::string>>(values.begin(), values.end()));
}

PgArguments& PgArguments::Blobs(const std::vector<std::optional<std::string>>& values) {
  return Add(kByteaArray, TextArray(kBytea, values));
}

}  // namespace homing::storage::postgres
