// Man pages and completion of a small command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "cli/completion.h"
#include "cli/documentation_flag.h"
#include "cli/examples.h"

namespace homing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class DocumentationTest : public ::testing::Test {
 protected:
  DocumentationTest() {
    app_.add_option("--server", server_, "Address of the server")
        ->envname("TOY_SERVER")
        ->capture_default_str();
    CLI::App* send = app_.add_subcommand("send", "Send something");
    send->fallthrough();
    send->add_option("--form", form_, "Form of it")->check(CLI::IsMember({"long", "short"}));
    send->add_option("file", file_, ".profile or another file")->required();
    CLI::App* maps = app_.add_subcommand("maps", "Maps");
    maps->add_subcommand("list", "List the maps");
    app_.require_subcommand(1);
    const std::array examples = {Example{"send", "toy send it's.txt"}};
    AddExamples(app_, examples);
  }

  // What bash offers for the last of `words`.
  std::string Complete(const std::string& words) {
    const std::string script = ::testing::TempDir() + "toy.bash";
    std::ofstream(script) << ToBashCompletion(app_);
    const std::string command = "bash -c '. " + script + "; COMP_WORDS=(" + words +
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _toy; echo "
                                "\"${COMPREPLY[*]}\"'";
    std::string output;
    FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 256> part{};
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) output += part.data();
    ::pclose(pipe);
    return output;
  }

  std::string server_ = "here:1";
  std::string form_;
  std::string file_;
  CLI::App app_{"Sends things", "toy"};
};

TEST_F(DocumentationTest, TheManPageHasWhatHelpHas) {
  ManPage page;
  page.version = "toy 1.0";
  page.exit_status = {"3: Nobody is there."};
  const std::string text = ToManPage(app_, page);
  EXPECT_THAT(text, HasSubstr(".TH TOY 1 \"\" \"toy 1.0\" \"User Commands\"\n.SH NAME\ntoy \\- "
                              "sends things\n"));
  EXPECT_THAT(text, HasSubstr("\\fB\\-\\-server\\fR \\fITEXT\\fR\nAddress of the server (default: "
                              "here:1) (environment: \\fBTOY_SERVER\\fR)"));
  EXPECT_THAT(text, HasSubstr(".SS \\fBtoy send\\fR [\\fIOPTIONS\\fR] \\fIFILE\\fR\n"));
  EXPECT_THAT(text, HasSubstr("\\fB\\-\\-form\\fR \\fIlong|short\\fR\n"));
  EXPECT_THAT(text, HasSubstr(".SS \\fBtoy maps list\\fR"));
  EXPECT_THAT(text, HasSubstr(".SH EXIT STATUS\n.TP\n\\fB3\\fR\nNobody is there.\n"));
}

TEST_F(DocumentationTest, NoLineOfTextIsTakenForARequest) {
  const std::string text = ToManPage(app_, {});
  EXPECT_THAT(text, HasSubstr("\n\\&.profile or another file (required)\n"));
  EXPECT_THAT(text, HasSubstr("toy send it\\(aqs.txt"));
}

TEST_F(DocumentationTest, BashOffersCommandsFlagsAndWords) {
  EXPECT_EQ(Complete("toy \"\""), "send maps\n");
  EXPECT_EQ(Complete("toy maps \"\""), "list\n");
  EXPECT_EQ(Complete("toy send --f"), "--form\n");
  EXPECT_THAT(Complete("toy send --"), HasSubstr("--server"));
  EXPECT_THAT(Complete("toy --"), Not(HasSubstr("--form")));
  EXPECT_EQ(Complete("toy send --form \"\""), "long short\n");
  EXPECT_EQ(Complete("toy send --server \"\""), "\n");
}

TEST_F(DocumentationTest, ZshHasAFunctionForEachCommand) {
  const std::string text = ToZshCompletion(app_);
  EXPECT_THAT(text, HasSubstr("#compdef toy\n"));
  EXPECT_THAT(text, HasSubstr("_toy_maps_list() {"));
  EXPECT_THAT(text, HasSubstr("'--form[Form of it]:value:(long short)'"));
}

TEST_F(DocumentationTest, TheFlagIsHiddenAndPrints) {
  AddDocumentationFlag(app_, {});
  EXPECT_THAT(app_.help(), Not(HasSubstr("documentation")));
  try {
    app_.parse("--documentation zsh");
    FAIL() << "parsed";
  } catch (const CLI::ParseError& printed) {
    EXPECT_EQ(printed.get_exit_code(), 0);
    EXPECT_EQ(std::string(printed.what()) + "\n", ToZshCompletion(app_));
  }
}

TEST_F(DocumentationTest, ExamplesAreInTheHelpOfTheirCommand) {
  EXPECT_THAT(app_.get_subcommand("send")->help(), HasSubstr("Example:\n  toy send it's.txt"));
  const std::array wrong = {Example{"fetch", "toy fetch"}};
  EXPECT_THROW(AddExamples(app_, wrong), CLI::OptionNotFound);
}

}  // namespace
}  // namespace homing
