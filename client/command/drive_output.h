// The output of `homing drive`.
#ifndef CLIENT_COMMAND_DRIVE_OUTPUT_H_
#define CLIENT_COMMAND_DRIVE_OUTPUT_H_

#include <string>

#include "absl/status/status.h"
#include "client/command/session.h"
#include "client/drive/home_drive.h"

namespace homing::client {

// The robot has reached home within this distance, m.
inline constexpr double kAtHomeM = 1;

// A line for each frame and the verdict, on stdout; drive.png and drive.csv in `folder`, if it is
// not empty. ABORTED: the robot did not come home.
absl::Status ReportDrive(const Session& session, const HomeDrive& drive, const Route& route,
                         double route_m, const std::string& folder);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_DRIVE_OUTPUT_H_
