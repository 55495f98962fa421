#include "client/command/command_line.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "cli/documentation_flag.h"
#include "client/command/commands.h"

namespace homing::client {
namespace {

constexpr std::array kExamples = {
    Example{"", "homing record --journey robots/r1/journeys/monday --left frames/left"},
    Example{"", "homing localize --journey robots/r1/journeys/monday --left back/left"},
    Example{"record",
            "homing record --journey robots/r1/journeys/monday --left 'out/left/*.png' "
            "--right 'out/right/*.png'"},
    Example{"record", "homing record --journey robots/r1/journeys/live --left /dev/video0"},
    Example{"localize",
            "homing localize --journey robots/r1/journeys/monday --left back/left --right "
            "back/right"},
    Example{"localize",
            "homing localize --journey robots/-/journeys/- --left /dev/video0 --travel same "
            "--send flow --json"},
    Example{"match",
            "homing match --journey robots/r1/journeys/monday --left 0041.png,0042.png --travel "
            "same"},
    Example{"journeys", "homing journeys list robots/r1"},
    Example{"journeys list", "homing journeys list robots/r1"},
    Example{"journeys show", "homing journeys show robots/r1/journeys/monday"},
    Example{"journeys finish", "homing journeys finish robots/r1/journeys/monday"},
    Example{"journeys set-readers",
            "homing journeys set-readers robots/r1/journeys/monday robots/r2 robots/r3"},
    Example{"journeys delete", "homing journeys delete robots/r1/journeys/monday"},
    Example{"journeys export", "homing journeys export robots/r1/journeys/monday monday.homing"},
    Example{"journeys import", "homing journeys import robots/r2/journeys/monday monday.homing"},
    Example{"train", "homing train --width 640 --height 480 --focal 554 --plot figures"},
    Example{"simulate", "homing simulate --scene street,length=60,speed=5 --out drive"},
    Example{"draw", "homing draw --journey robots/r1/journeys/monday --out monday.png"},
    Example{"draw", "homing draw --left 0041.png,0042.png --histogram --out flow.svg"},
    Example{"backup", "homing backup copy.db"},
    Example{
        "drive",
        "homing drive --scene street,length=60 --journey robots/sim/journeys/street --out drive"},
    Example{"top", "homing top --once"},
    Example{"evaluate",
            "homing evaluate --answers home.json --truth-out out/truth.csv --truth-home "
            "home/truth.csv --out figures"},
};

ManPage Page(const std::string& version) {
  ManPage page;
  page.version = absl::StrCat("homing ", version);
  page.exit_status = {"0: The work is done.", "1: The work failed.",
                      "2: The command line is wrong.", "3: The server cannot be reached."};
  page.see_also = {"homing-server(8)", "homing-bench(1)"};
  return page;
}

}  // namespace

std::span<const Example> CommandExamples() { return kExamples; }

void AddCommandLine(CLI::App& app, Session& session, const char* version) {
  app.set_version_flag("--version", absl::StrCat("homing ", version));
  app.require_subcommand(1);
  app.fallthrough();
  AddCommonFlags(app, session);
  AddRecordCommand(app, session);
  AddLocalizeCommand(app, session);
  AddMatchCommand(app, session);
  AddJourneysCommand(app, session);
  AddTrainCommand(app, session);
  AddSimulateCommand(app, session);
  AddDrawCommand(app, session);
  AddBackupCommand(app, session);
  AddDriveCommand(app, session);
  AddTopCommand(app, session);
  AddEvaluateCommand(app, session);
  AddExamples(app, kExamples);
  AddDocumentationFlag(app, Page(version));
}

}  // namespace homing::client
