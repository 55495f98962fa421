#include "cli/man_page.h"

#include <map>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "cli/option_text.h"

namespace homing {
namespace {

// A line of text: troff takes a leading dot or quote for a request.
std::string Escaped(const std::string& text) {
  const std::string safe =
      absl::StrReplaceAll(text, {{"\\", "\\e"}, {"-", "\\-"}, {"'", "\\(aq"}, {"`", "\\(ga"}});
  const bool request = absl::StartsWith(safe, ".");
  return absl::StrCat(request ? "\\&" : "", safe);
}

std::string Bold(const std::string& text) { return absl::StrCat("\\fB", Escaped(text), "\\fR"); }
std::string Slanted(const std::string& text) { return absl::StrCat("\\fI", Escaped(text), "\\fR"); }

std::string HeadOf(const CLI::Option& option) {
  std::vector<std::string> flags;
  for (const std::string& flag : FlagsOf(option)) flags.push_back(Bold(flag));
  std::string head = absl::StrJoin(flags, ", ");
  if (flags.empty()) return Slanted(ValueName(option));
  if (TakesValue(option)) absl::StrAppend(&head, " ", Slanted(ValueName(option)));
  return head;
}

std::string OptionEntry(const CLI::Option& option) {
  std::string text = Escaped(option.get_description());
  if (option.get_required()) absl::StrAppend(&text, " (required)");
  const std::string initial = option.get_default_str();
  if (TakesValue(option) && !initial.empty()) {
    absl::StrAppend(&text, " (default: ", Escaped(initial), ")");
  }
  if (!option.get_envname().empty()) {
    absl::StrAppend(&text, " (environment: ", Bold(option.get_envname()), ")");
  }
  return absl::StrCat(".TP\n", HeadOf(option), "\n", text, "\n");
}

std::string Options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : VisibleOptions(app)) {
    const bool help = option == app.get_help_ptr();
    if (!help) absl::StrAppend(&text, OptionEntry(*option));
  }
  return text;
}

std::string Verbatim(const std::string& lines) {
  std::string text = ".nf\n";
  for (const auto& line : absl::StrSplit(absl::StripAsciiWhitespace(lines), '\n')) {
    absl::StrAppend(&text, Escaped(std::string(line)), "\n");
  }
  return text + ".fi\n";
}

std::string Synopsis(const std::string& path, const CLI::App& app) {
  std::string text = Bold(path);
  for (const CLI::Option* option : VisibleOptions(app)) {
    if (option->get_required() && option->nonpositional()) {
      absl::StrAppend(&text, " ", HeadOf(*option));
    }
  }
  absl::StrAppend(&text, " [", Slanted("OPTIONS"), "]");
  for (const CLI::Option* option : VisibleOptions(app)) {
    if (!option->nonpositional()) absl::StrAppend(&text, " ", Slanted(ValueName(*option)));
  }
  if (!Subcommands(app).empty()) absl::StrAppend(&text, " ", Slanted("COMMAND"));
  return text;
}

std::string Commands(const std::string& path, const CLI::App& app) {
  std::string text;
  for (const CLI::App* command : Subcommands(app)) {
    const std::string name = absl::StrCat(path, " ", command->get_name());
    absl::StrAppend(&text, ".SS ", Synopsis(name, *command), "\n",
                    Escaped(command->get_description()), ".\n", Options(*command));
    if (!command->get_footer().empty()) {
      absl::StrAppend(&text, ".PP\n", Verbatim(command->get_footer()));
    }
    absl::StrAppend(&text, Commands(name, *command));
  }
  return text;
}

std::string Section(const std::string& title, const std::string& text) {
  return text.empty() ? "" : absl::StrCat(".SH ", title, "\n", text);
}

std::string Lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    const std::vector<std::string> parts = absl::StrSplit(line, absl::MaxSplits(": ", 1));
    absl::StrAppend(&text, ".TP\n", Bold(parts.front()), "\n", Escaped(parts.back()), "\n");
  }
  return text;
}

// "Records journeys" as the name's explanation begins with a small letter.
std::string SmallFirst(std::string text) {
  if (!text.empty()) text[0] = absl::ascii_tolower(static_cast<unsigned char>(text[0]));
  if (absl::EndsWith(text, ".")) text.pop_back();
  return text;
}

}  // namespace

std::string ToManPage(const CLI::App& app, const ManPage& page) {
  const std::string& name = app.get_name();
  std::string text =
      absl::StrCat(".TH ", absl::AsciiStrToUpper(name), " ", page.section, " \"\" \"", page.version,
                   "\" \"", page.section == 8 ? "System Administration" : "User Commands", "\"\n");
  absl::StrAppend(&text,
                  Section("NAME", absl::StrCat(Escaped(name), " \\- ",
                                               Escaped(SmallFirst(app.get_description())), "\n")));
  absl::StrAppend(&text, Section("SYNOPSIS", Synopsis(name, app) + "\n"));
  absl::StrAppend(&text, Section("OPTIONS", Options(app)));
  absl::StrAppend(&text, Section("COMMANDS", Commands(name, app)));
  absl::StrAppend(&text, Section("EXIT STATUS", Lines(page.exit_status)));
  absl::StrAppend(&text, Section("FILES", Lines(page.files)));
  const std::string footer = app.get_footer();
  if (!footer.empty()) absl::StrAppend(&text, Section("EXAMPLES", Verbatim(footer)));
  if (!page.see_also.empty()) {
    absl::StrAppend(&text, Section("SEE ALSO", absl::StrJoin(page.see_also, ", ") + "\n"));
  }
  return text;
}

}  // namespace homing
