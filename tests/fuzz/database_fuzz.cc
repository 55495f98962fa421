// Database files. Input: a byte, then (0) the whole file, or else changes of a good one: where it
// ends, then four bytes each: where, and what is put there.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "storage/doctor.h"
#include "storage/journey_store.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/route.h"

namespace homing::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr char kJourney[] = "robots/r/journeys/a";

std::string PathOf(const std::string& name) {
  // In memory.
  return "/dev/shm/homing_fuzz_" + std::to_string(::getpid()) + "_" + name;
}

void Remove(const std::string& path) {
  std::error_code ignored;
  for (const char* end : {"", "-wal", "-shm", "-journal", "-lock"}) fs::remove(path + end, ignored);
}

auto Open(const std::string& path) {
  storage::StoreOptions options;
  options.url = "sqlite:" + path;
  options.busy_timeout_ms = 0;
  return storage::OpenJourneyStore(options);
}

storage::JourneyAppend Next(JourneyRecorder* recorder, std::int64_t sequence) {
  storage::JourneyAppend append;
  append.journey = kJourney;
  append.sequence = sequence;
  append.input = InputKind::kFlowVectors;
  append.step = *recorder->Record(test::FlowAt(sequence));
  append.settings = recorder->settings();
  return append;
}

// A journey of thirty steps and a model.
std::string MakeGoodFile() {
  const std::string path = PathOf("good");
  Remove(path);
  {
    auto store = Open(path);
    Require(store.ok());
    storage::JourneyRecord record;
    record.name = kJourney;
    Require((*store)->CreateJourney(record).ok());
    JourneyRecorder recorder{JourneySettings{}};
    for (int i = 0; i < 30; ++i) Require((*store)->AppendSteps({Next(&recorder, i)})[0].ok());
    storage::StoredModel model;
    model.name = "deviationModels/m";
    Require((*store)->CreateModel(model).ok());
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  Remove(path);
  return bytes;
}

std::string TakeFile(FuzzInput input) {
  static const std::string good = MakeGoodFile();
  if (input.Take<std::uint8_t>() == 0) return std::string(input.rest());
  std::string bytes = good;
  const auto end = input.Take<std::uint16_t>();
  if (end != 0) bytes.resize(std::min<std::size_t>(bytes.size(), end));
  while (!input.empty()) {
    const auto low = input.Take<std::uint16_t>();
    const auto high = static_cast<std::uint32_t>(input.Take<std::uint8_t>() & 1);
    const std::size_t at = low | high << 16;
    const auto value = input.Take<char>();
    if (!bytes.empty()) bytes[at % bytes.size()] = value;
  }
  return bytes;
}

void UseStore(storage::JourneyStore* store) {
  const auto journeys = store->ListJourneys("", "", 100);
  if (journeys.ok()) {
    for (const storage::JourneyRecord& record : *journeys)
      store->LoadMap(record.name).IgnoreError();
  }
  JourneyRecorder recorder{JourneySettings{}};
  store->AppendSteps({Next(&recorder, 0)});
  store->ListModels("", 100).IgnoreError();
  store->FinishJourney(kJourney).IgnoreError();
  store->DeleteJourney(kJourney).IgnoreError();
}

void Run(const std::string& bytes) {
  const std::string path = PathOf("db");
  const std::string saved = PathOf("saved");
  Remove(path);
  Remove(saved);
  std::ofstream(path, std::ios::binary) << bytes;
  storage::Salvage(path, saved).IgnoreError();
  if (const auto store = Open(saved); store.ok()) {
    const auto journeys = (*store)->ListJourneys("", "", 100);
    Require(journeys.ok());
    for (const auto& record : *journeys) Require((*store)->LoadMap(record.name).ok());
  }
  if (const auto store = Open(path); store.ok()) UseStore(store->get());
  Remove(path);
  Remove(saved);
}

}  // namespace
}  // namespace homing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::Run(homing::fuzz::TakeFile({data, size}));
  return 0;
}
