#include "tests/accuracy/drive_cache.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"

namespace homing::accuracy {
namespace {

template <typename T>
void Put(std::ostream& file, const T* values, std::size_t count) {
  file.write(reinterpret_cast<const char*>(values),
             static_cast<std::streamsize>(count * sizeof(T)));
}

template <typename T>
void Get(std::istream& file, T* values, std::size_t count) {
  file.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

void PutInstant(std::ostream& file, const Instant& instant) {
  Put(file, &instant.frame, 1);
  Put(file, &instant.reference, 1);
  Put(file, &instant.place, 1);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& field = instant.flow.fields[side];
    const std::array<std::int32_t, 3> head{
        field ? field->width : 0, field ? field->height : 0,
        field ? static_cast<std::int32_t>(field->vectors.size()) : -1};
    Put(file, head.data(), head.size());
    if (!field) continue;
    Put(file, field->vectors.data(), field->vectors.size());
    Put(file, instant.pictures[side].data(), instant.pictures[side].size());
  }
}

Instant GetInstant(std::istream& file) {
  Instant instant;
  Get(file, &instant.frame, 1);
  Get(file, &instant.reference, 1);
  Get(file, &instant.place, 1);
  for (std::size_t side = 0; side < 2; ++side) {
    std::array<std::int32_t, 3> head{};
    Get(file, head.data(), head.size());
    if (!file || head[2] < 0) continue;
    FlowField field{.width = head[0], .height = head[1], .vectors = {}};
    field.vectors.resize(static_cast<std::size_t>(head[2]));
    Get(file, field.vectors.data(), field.vectors.size());
    instant.flow.fields[side] = std::move(field);
    instant.pictures[side].resize(std::size_t{kPictureWidth} * kPictureHeight);
    Get(file, instant.pictures[side].data(), instant.pictures[side].size());
  }
  return instant;
}

}  // namespace

std::string DriveCache::PathOf(const std::string& name) const {
  std::string file = name;
  std::ranges::replace(file, '/', '_');
  return absl::StrCat(folder_, "/", file, ".drive");
}

std::optional<Drive> DriveCache::Read(const std::string& name) const {
  if (folder_.empty()) return std::nullopt;
  std::ifstream file(PathOf(name), std::ios::binary);
  if (!file) return std::nullopt;
  std::uint64_t size = 0;
  Get(file, &size, 1);
  Drive drive;
  for (std::uint64_t i = 0; i < size && file; ++i) drive.push_back(GetInstant(file));
  if (!file) Fail(PathOf(name) + " is damaged; delete the cache");
  return drive;
}

void DriveCache::Write(const std::string& name, const Drive& drive) const {
  if (folder_.empty()) return;
  const std::string part = absl::StrCat(PathOf(name), ".", getpid(), ".part");
  std::ofstream file(part, std::ios::binary);
  const std::uint64_t size = drive.size();
  Put(file, &size, 1);
  for (const Instant& instant : drive) PutInstant(file, instant);
  file.close();
  if (!file) Fail("cannot write " + part);
  std::filesystem::rename(part, PathOf(name));
}

}  // namespace homing::accuracy
