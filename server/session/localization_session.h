// Localises one robot on its way home, on the journeys that it asks for.
#ifndef SERVER_SESSION_LOCALIZATION_SESSION_H_
#define SERVER_SESSION_LOCALIZATION_SESSION_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/localization/localizer.h"
#include "server/catalog/journey_catalog.h"
#include "server/catalog/journey_selection.h"

namespace homing::server {

// The robot's place before its link broke.
struct LocalizationPrior {
  std::string journey;
  PositionPrior start;
};

struct LocalizationQuery {
  // Name or pattern; `filter` selects the journeys that the caller may use. It is asked again each
  // second.
  std::string journey;
  JourneyFilter filter;
  Travel travel = Travel::kReturn;
  std::array<std::optional<Camera>, 2> cameras;
  MatchOptions match;
  PositionOptions position;
  std::optional<LocalizationPrior> prior;
};

// Not thread-safe. The first observation selects the journeys, once image sizes are known; their
// maps may grow afterwards, and a wildcard's may be deleted. Nothing is stored.
class LocalizationSession {
 public:
  // `catalog` must outlive the session. INVALID_ARGUMENT, NOT_FOUND, FAILED_PRECONDITION (the named
  // journey's camera).
  static absl::StatusOr<std::unique_ptr<LocalizationSession>> Open(JourneyCatalog* catalog,
                                                                   const LocalizationQuery& query,
                                                                   const DecodeLimits& limits);

  // The first observation may have any sequence; each later one must have the next: OUT_OF_RANGE.
  // PERMISSION_DENIED: the caller is no reader of it any more.
  // NOT_FOUND: the named journey was deleted, or all of a wildcard. After one of a wildcard was
  // deleted, the belief over the others is kept, as after a break. FAILED_PRECONDITION: other
  // camera or settings. INVALID_ARGUMENT. RESOURCE_EXHAUSTED: as JourneyCatalog::LoadMaps.
  absl::StatusOr<Localization> Localize(const Observation& observation);

  // The distribution of the robot's place on one journey after the last observation, in at most
  // `most` groups of consecutive steps.
  struct Belief {
    std::int64_t step_count = 0;
    std::int64_t first_step = 0;
    std::int64_t steps_each = 1;
    std::vector<float> masses;
  };
  // Empty before the first observation.
  Belief BeliefOn(int journey, std::size_t most) const;

  // The name of the journey with this number in a Localization.
  const std::string& journey_name(int index) const {
    return journeys_[static_cast<std::size_t>(index)]->name();
  }

 private:
  LocalizationSession(JourneyCatalog* catalog, const LocalizationQuery& query, JourneyName pattern,
                      const DecodeLimits& limits)
      : catalog_(catalog),
        query_(query),
        pattern_(std::move(pattern)),
        limits_(limits),
        prior_(query.prior),
        memory_(catalog->beliefs()) {}
  // Takes the memory of a belief over all steps of the journeys, which an unsure robot needs, and
  // of its frames. RESOURCE_EXHAUSTED.
  absl::Status TakeMemory();
  // Gives back what the belief does not hold any more.
  void GiveMemoryBack();
  absl::Status CheckSequence(std::int64_t sequence);
  absl::Status Start(const Observation& observation);
  absl::Status StartAt(const LocalizationPrior& prior, std::span<const JourneyRef> journeys);
  // The journey was deleted, or the caller may not use it any more.
  bool IsLost(const LiveJourney& journey, bool check_rights) const;
  // Continues without the lost journeys. NOT_FOUND, PERMISSION_DENIED: none is left.
  absl::Status LeaveLost();

  JourneyCatalog* const catalog_;
  const LocalizationQuery query_;
  const JourneyName pattern_;
  const DecodeLimits limits_;
  LiveJourneys journeys_;
  std::chrono::steady_clock::time_point rights_checked_ = std::chrono::steady_clock::now();
  LocalizerOptions options_;
  std::optional<Localizer> localizer_;
  // The start of the localiser.
  std::optional<LocalizationPrior> prior_;
  // The position of the last answer.
  Position position_;
  std::optional<std::int64_t> expected_;
  bool started_ = false;
  std::int64_t image_bytes_ = 0;
  MemoryBudget::Share memory_;
};

}  // namespace homing::server

#endif  // SERVER_SESSION_LOCALIZATION_SESSION_H_
