// The methods of the API, as rights and metrics see them.
#ifndef SERVER_ACCESS_RPC_H_
#define SERVER_ACCESS_RPC_H_

#include <array>
#include <string_view>

namespace homing::server {

enum class Rpc {
  kCreateJourney,
  kGetJourney,
  kListJourneys,
  kDeleteJourney,
  kFinishJourney,
  kSetReaders,
  kRecordJourney,
  kListLandmarks,
  kAnalyzeAliasing,
  kDescribeRoute,
  kExportJourney,
  kImportJourney,
  kMatchLandmarks,
  kLocalize,
  kTrainDeviationModel,
  kGetDeviationModel,
  kListDeviationModels,
  kBackUpStore,
  kListRobots,
  kWatchFleet,
  kWatchRobot,
};

// The kind of access that a method needs.
enum class Right {
  // Creates, records, finishes, imports a journey.
  kWrite,
  kDelete,
  // Lists journeys, with their settings and counts.
  kSee,
  // Reads the map itself: landmarks, aliasing, export.
  kTakeMap,
  // Localises on the journey.
  kLocalize,
  // Trains a deviation model, which all robots share.
  kTrain,
  kSeeModels,
  // Reads the whole store.
  kBackUp,
  // Sees the live state of robots.
  kSeeFleet,
};

struct RpcTraits {
  Rpc rpc;
  // "homing.v1.JourneyService/CreateJourney".
  std::string_view method;
  Right right;
  // The request's field that names the resource; empty: none.
  std::string_view field;
};

inline constexpr std::array<RpcTraits, 21> kRpcs = {{
    {Rpc::kCreateJourney, "homing.v1.JourneyService/CreateJourney", Right::kWrite, "parent"},
    {Rpc::kGetJourney, "homing.v1.JourneyService/GetJourney", Right::kSee, "name"},
    {Rpc::kListJourneys, "homing.v1.JourneyService/ListJourneys", Right::kSee, "parent"},
    {Rpc::kDeleteJourney, "homing.v1.JourneyService/DeleteJourney", Right::kDelete, "name"},
    {Rpc::kFinishJourney, "homing.v1.JourneyService/FinishJourney", Right::kWrite, "name"},
    {Rpc::kSetReaders, "homing.v1.JourneyService/SetReaders", Right::kDelete, "name"},
    {Rpc::kRecordJourney, "homing.v1.JourneyService/RecordJourney", Right::kWrite,
     "config.journey"},
    {Rpc::kListLandmarks, "homing.v1.JourneyService/ListLandmarks", Right::kTakeMap, "parent"},
    {Rpc::kAnalyzeAliasing, "homing.v1.JourneyService/AnalyzeAliasing", Right::kTakeMap, "name"},
    {Rpc::kDescribeRoute, "homing.v1.JourneyService/DescribeRoute", Right::kTakeMap, "name"},
    {Rpc::kExportJourney, "homing.v1.JourneyService/ExportJourney", Right::kTakeMap, "name"},
    {Rpc::kImportJourney, "homing.v1.JourneyService/ImportJourney", Right::kWrite, "name"},
    {Rpc::kMatchLandmarks, "homing.v1.HomingService/MatchLandmarks", Right::kLocalize, "journey"},
    {Rpc::kLocalize, "homing.v1.HomingService/Localize", Right::kLocalize, "config.journey"},
    {Rpc::kTrainDeviationModel, "homing.v1.DeviationModelService/TrainDeviationModel",
     Right::kTrain, ""},
    {Rpc::kGetDeviationModel, "homing.v1.DeviationModelService/GetDeviationModel",
     Right::kSeeModels, ""},
    {Rpc::kListDeviationModels, "homing.v1.DeviationModelService/ListDeviationModels",
     Right::kSeeModels, ""},
    {Rpc::kBackUpStore, "homing.v1.StoreService/BackUpStore", Right::kBackUp, ""},
    {Rpc::kListRobots, "homing.v1.FleetService/ListRobots", Right::kSeeFleet, ""},
    {Rpc::kWatchFleet, "homing.v1.FleetService/WatchFleet", Right::kSeeFleet, ""},
    {Rpc::kWatchRobot, "homing.v1.FleetService/WatchRobot", Right::kSeeFleet, "name"},
}};

// In the order of Rpc.
inline const RpcTraits& TraitsOf(Rpc rpc) { return kRpcs[static_cast<std::size_t>(rpc)]; }

}  // namespace homing::server

#endif  // SERVER_ACCESS_RPC_H_
