// Examples in the help of `homing`.
#include "client/command/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace homing::client {
namespace {

TEST(CommandLineTest, EveryExampleIsAValidCommandLine) {
  for (const Example& example : CommandExamples()) {
    Session session;
    CLI::App app("Test", "homing");
    AddCommandLine(app, session, "1.0");
    const std::string line(example.line);
    ASSERT_EQ(line.rfind("homing ", 0), 0u) << line;
    EXPECT_NO_THROW(app.parse(line.substr(7), /*program_name_included=*/false)) << line;
    EXPECT_TRUE(session.run) << line;
  }
}

void ExpectExamples(const CLI::App& app) {
  EXPECT_NE(app.get_footer(), "") << app.get_name();
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    ExpectExamples(*command);
  }
}

TEST(CommandLineTest, EveryCommandHasAnExample) {
  Session session;
  CLI::App app("Test", "homing");
  AddCommandLine(app, session, "1.0");
  ExpectExamples(app);
}

}  // namespace
}  // namespace homing::client
