#include "client/simulator/frame_schedule.h"

#include <algorithm>
#include <cmath>

#include "client/simulator/seeded_random.h"
#include "client/simulator/simulation_spec.h"

namespace homing::client {

FrameSchedule::FrameSchedule(const SimulationSpec& spec, std::int64_t taken)
    : seed_(Mix(DriveSeed(spec), spec.seed, 78)),
      repeat_(static_cast<std::int64_t>(spec.repeat)),
      kept_a_block_(kBlock - std::lround(spec.drop * kBlock)),
      drop_run_(static_cast<std::int64_t>(spec.drop_run)),
      frame_count_(taken) {
  if (kept_a_block_ < kBlock) {
    const auto kept = KeptIn(taken / kBlock);
    frame_count_ = taken / kBlock * kept_a_block_ +
                   std::ranges::count_if(kept, [&](std::int64_t i) { return i < taken % kBlock; });
  }
  if (repeat_ > 0) {
    frame_count_ += frame_count_ / (repeat_ - 1);
  }
}

std::vector<std::int64_t> FrameSchedule::KeptIn(std::int64_t block) const {
  const auto key = [&](std::int64_t i) {
    return Mix(seed_, static_cast<std::uint64_t>(block), static_cast<std::uint64_t>(i));
  };
  std::vector<std::int64_t> frames;
  for (std::int64_t i = 0; i < kBlock; ++i) {
    frames.push_back(i);
  }
  std::ranges::sort(frames, {}, key);
  frames.resize(static_cast<std::size_t>(kept_a_block_));
  std::ranges::sort(frames);
  return frames;
}

std::int64_t FrameSchedule::TakenAt(std::int64_t index) const {
  const std::int64_t kept = repeat_ > 0 ? index - (index + 1) / repeat_ : index;
  if (kept_a_block_ == kBlock) {
    return kept;
  }
  const std::int64_t block = kept / kept_a_block_;
  return block * kBlock + KeptIn(block)[static_cast<std::size_t>(kept % kept_a_block_)];
}

bool FrameSchedule::IsAbsent(std::int64_t taken, Side camera) const {
  if (drop_run_ == 0) {
    return false;
  }
  const std::int64_t stretch = taken / (5 * drop_run_);
  SeededRandom random(Mix(seed_, 80, static_cast<std::uint64_t>(stretch)));
  const Side lost = random.Chance(0.5) ? Side::kLeft : Side::kRight;
  // The first loss is not at the beginning: a drive starts with both cameras.
  const auto first = static_cast<std::int64_t>(
      random.Uniform(static_cast<double>(drop_run_), static_cast<double>(4 * drop_run_ + 1)));
  const std::int64_t at = taken % (5 * drop_run_);
  return camera == lost && at >= first && at < first + drop_run_;
}

}  // namespace homing::client
