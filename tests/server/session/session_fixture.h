// A store on disk with the session layer's objects, and a listener that tests can wait for.
#ifndef TESTS_SERVER_SESSION_SESSION_FIXTURE_H_
#define TESTS_SERVER_SESSION_SESSION_FIXTURE_H_

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/catalog/journey_catalog.h"
#include "server/session/landmark_query.h"
#include "server/session/recording_session.h"
#include "storage/commit_queue.h"
#include "tests/support/route.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {

inline constexpr char kJourney[] = "robots/r/journeys/out";

// Both parts of a query.
inline absl::StatusOr<LandmarkQueryResult> LoadAndMatch(JourneyCatalog* catalog,
                                                        const LandmarkQuery& query) {
  HOMING_ASSIGN_OR_RETURN(const QueryJourneys journeys, LoadQueryJourneys(catalog, query, {}));
  return MatchLandmarks(catalog, query, journeys, {});
}

// The answers of a recording stream; its listener may outlive it. Waits have no timeout: a lost
// answer makes the test hang until the runner ends it.
class Ear {
 public:
  RecordingListener Listener() {
    return {[heard = heard_](RecordingAnswer answer) {
              const MutexLock lock(heard->mutex);
              heard->answers.push_back(std::move(answer));
              heard->changed.NotifyAll();
            },
            [heard = heard_](absl::Status status) {
              const MutexLock lock(heard->mutex);
              heard->end = std::move(status);
              heard->changed.NotifyAll();
            }};
  }
  // The first answer is one of them.
  std::vector<RecordingAnswer> AwaitAnswers(std::size_t count) {
    MutexLock lock(heard_->mutex);
    while (heard_->answers.size() < count && !heard_->end) heard_->changed.Wait(heard_->mutex);
    return heard_->answers;
  }
  absl::Status AwaitEnd() {
    MutexLock lock(heard_->mutex);
    while (!heard_->end) heard_->changed.Wait(heard_->mutex);
    return *heard_->end;
  }
  bool ended() {
    const MutexLock lock(heard_->mutex);
    return heard_->end.has_value();
  }

 private:
  struct Heard {
    Mutex mutex;
    ConditionVariable changed;
    std::vector<RecordingAnswer> answers;
    std::optional<absl::Status> end;
  };
  std::shared_ptr<Heard> heard_ = std::make_shared<Heard>();
};

class SessionTest : public ::testing::Test {
 protected:
  SessionTest() { OpenStore(0); }

  // As after a restart of the server. max_bytes 0: no limit.
  void OpenStore(std::int64_t max_bytes) {
    queue_.reset();
    catalog_.reset();
    store_.reset();
    storage::StoreOptions options;
    options.url = folder_.Database();
    options.max_bytes = max_bytes;
    auto store = storage::OpenJourneyStore(options);
    ASSERT_THAT(store, IsOk());
    store_ = *std::move(store);
    catalog_ = std::make_unique<JourneyCatalog>(store_.get());
    queue_ = std::make_unique<storage::CommitQueue>(store_.get());
  }

  void Create(const std::string& name = kJourney, const std::string& writer = "writer") {
    storage::JourneyRecord record;
    record.name = name;
    record.writer_id = writer;
    record.create_time_ns = 1;
    ASSERT_THAT(catalog_->Create(record), IsOk());
  }

  absl::StatusOr<std::shared_ptr<RecordingSession>> Open(Ear* ear, TimePoint now = {},
                                                         const std::string& writer = "writer",
                                                         const std::string& name = kJourney) {
    return RecordingSession::Open({catalog_.get(), queue_.get(), {}}, name, writer, now,
                                  ear->Listener());
  }

  // Records places [first, last) as flow vectors; all must be answered.
  void RecordFlow(int first, int last, const std::string& name = kJourney) {
    Ear ear;
    const auto session = Open(&ear, {}, "writer", name);
    ASSERT_THAT(session, IsOk());
    for (int i = first; i < last; ++i) {
      (*session)->Record(test::FlowAt(i), {});
    }
    const auto answers = ear.AwaitAnswers(static_cast<std::size_t>(last - first) + 1);
    ASSERT_EQ(answers.back().next_sequence, last);
  }

  TemporaryFolder folder_;
  std::unique_ptr<storage::JourneyStore> store_;
  std::unique_ptr<JourneyCatalog> catalog_;
  std::unique_ptr<storage::CommitQueue> queue_;
};

// All fingerprints, steps and landmarks are alike.
inline void ExpectSameMap(const JourneyMap& a, const JourneyMap& b) {
  ASSERT_EQ(a.step_count(), b.step_count());
  EXPECT_EQ(a.landmarks(), b.landmarks());
  for (std::int64_t step = 0; step < a.step_count(); ++step) {
    const auto x = a.fingerprints(step);
    const auto y = b.fingerprints(step);
    ASSERT_TRUE(std::equal(x.begin(), x.end(), y.begin(), y.end())) << "step " << step;
    ASSERT_EQ(a.sequence(step), b.sequence(step)) << "step " << step;
  }
}

}  // namespace homing::server

#endif  // TESTS_SERVER_SESSION_SESSION_FIXTURE_H_
