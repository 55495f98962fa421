#include "cli/completion.h"

#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cli/option_text.h"

namespace homing {
namespace {

// Flags of the command and, since they may stand behind a subcommand, of those above it.
void AddFlags(const std::vector<const CLI::App*>& path, std::set<std::string>* flags) {
  for (const CLI::App* app : path) {
    for (const CLI::Option* option : VisibleOptions(*app)) {
      for (const std::string& flag : FlagsOf(*option)) flags->insert(flag);
    }
  }
}

std::string PathText(const std::vector<const CLI::App*>& path) {
  return absl::StrJoin(path, " ", [](std::string* text, const CLI::App* app) {
    absl::StrAppend(text, app->get_name());
  });
}

// One branch "COMMAND PATH) words=...": what may come next.
void BashPaths(std::vector<const CLI::App*> path, std::string* text) {
  std::set<std::string> words;
  AddFlags(path, &words);
  std::vector<std::string> commands;
  for (const CLI::App* command : Subcommands(*path.back())) commands.push_back(command->get_name());
  absl::StrAppend(text, "    '", PathText(path), "') flags='", absl::StrJoin(words, " "),
                  "' commands='", absl::StrJoin(commands, " "), "' ;;\n");
  for (const CLI::App* command : Subcommands(*path.back())) {
    path.push_back(command);
    BashPaths(path, text);
    path.pop_back();
  }
}

// One branch "COMMAND PATH --flag) values": the words that the flag accepts, or "-" for files.
void BashValues(std::vector<const CLI::App*> path, std::string* text) {
  for (const CLI::Option* option : VisibleOptions(*path.back())) {
    if (!TakesValue(*option)) continue;
    for (const std::string& flag : FlagsOf(*option)) {
      const std::vector<std::string> choices = ChoicesOf(*option);
      absl::StrAppend(text, "    '", PathText(path), "'*' ", flag, "') values='",
                      choices.empty() ? "-" : absl::StrJoin(choices, " "), "' ;;\n");
    }
  }
  for (const CLI::App* command : Subcommands(*path.back())) {
    path.push_back(command);
    BashValues(path, text);
    path.pop_back();
  }
}

std::string FunctionName(const CLI::App& app) {
  return absl::StrCat("_", absl::StrReplaceAll(app.get_name(), {{"-", "_"}}));
}

// Text within single quotes and a specification of _arguments.
std::string ZshText(const std::string& text) {
  return absl::StrReplaceAll(
      text, {{"'", "'\\''"}, {"[", "\\["}, {"]", "\\]"}, {":", "\\:"}, {"\n", " "}});
}

std::string ZshOption(const CLI::Option& option) {
  const std::string help = ZshText(option.get_description());
  std::string text;
  std::vector<std::string> flags = FlagsOf(option);
  if (flags.empty()) {
    return absl::StrCat("    ':", ZshText(ValueName(option)), ":_files'\n");
  }
  for (const std::string& flag : flags) {
    absl::StrAppend(&text, "    '", option.get_expected_max() > 1 ? "*" : "", flag, "[", help, "]");
    if (TakesValue(option)) {
      const std::vector<std::string> choices = ChoicesOf(option);
      absl::StrAppend(
          &text, ":value:",
          choices.empty() ? "_files" : absl::StrCat("(", absl::StrJoin(choices, " "), ")"));
    }
    absl::StrAppend(&text, "'\n");
  }
  return text;
}

void ZshFunction(std::vector<const CLI::App*> path, const std::string& name, std::string* text) {
  const CLI::App& app = *path.back();
  absl::StrAppend(text, name, "() {\n  local line state\n  local -a arguments=(\n");
  for (const CLI::App* above : path) {
    for (const CLI::Option* option : VisibleOptions(*above)) {
      if (above != &app && (option == above->get_help_ptr() || !option->nonpositional())) continue;
      absl::StrAppend(text, ZshOption(*option));
    }
  }
  const std::vector<const CLI::App*> commands = Subcommands(app);
  if (commands.empty()) {
    absl::StrAppend(text, "  )\n  _arguments -s $arguments\n}\n");
    return;
  }
  absl::StrAppend(text, "    '1: :->command'\n    '*::argument:->rest'\n  )\n",
                  "  _arguments -s -C $arguments && return\n  case $state in\n    command)\n",
                  "      local -a commands=(\n");
  for (const CLI::App* command : commands) {
    absl::StrAppend(text, "        '", command->get_name(), ":",
                    ZshText(command->get_description()), "'\n");
  }
  absl::StrAppend(text, "      )\n      _describe command commands ;;\n    rest)\n",
                  "      case $line[1] in\n");
  for (const CLI::App* command : commands) {
    absl::StrAppend(text, "        ", command->get_name(), ") ", name, "_", command->get_name(),
                    " ;;\n");
  }
  absl::StrAppend(text, "      esac ;;\n  esac\n}\n");
  for (const CLI::App* command : commands) {
    path.push_back(command);
    ZshFunction(path, absl::StrCat(name, "_", command->get_name()), text);
    path.pop_back();
  }
}

}  // namespace

std::string ToBashCompletion(const CLI::App& app) {
  const std::string function = FunctionName(app);
  std::string paths;
  std::string values;
  BashPaths({&app}, &paths);
  BashValues({&app}, &values);
  return absl::StrCat(
      "# bash completion of ", app.get_name(), "\n", function, "() {\n",
      "  local word=${COMP_WORDS[COMP_CWORD]} path='", app.get_name(),
      "' flags='' commands='' values='' i next\n",
      "  local -a words=(\"${COMP_WORDS[@]:1:COMP_CWORD-1}\")\n",
      "  for i in \"${words[@]}\"; do\n", "    flags='' commands=''\n", "    ", function,
      "_words \"$path\"\n", "    for next in $commands; do\n",
      "      if [[ $i == \"$next\" ]]; then path+=\" $next\"; break; fi\n", "    done\n",
      "  done\n", "  ", function, "_words \"$path\"\n",
      "  case \"$path ${COMP_WORDS[COMP_CWORD-1]}\" in\n", values, "  esac\n",
      "  if [[ $values == - ]]; then\n", "    COMPREPLY=()\n", "  elif [[ $values ]]; then\n",
      "    mapfile -t COMPREPLY < <(compgen -W \"$values\" -- \"$word\")\n",
      "  elif [[ $word == -* ]]; then\n",
      "    mapfile -t COMPREPLY < <(compgen -W \"$flags\" -- \"$word\")\n", "  else\n",
      "    mapfile -t COMPREPLY < <(compgen -W \"$commands\" -- \"$word\")\n", "  fi\n", "}\n",
      function, "_words() {\n", "  case $1 in\n", paths, "  esac\n", "}\n",
      "complete -o default -F ", function, " ", app.get_name(), "\n");
}

std::string ToZshCompletion(const CLI::App& app) {
  std::string text = absl::StrCat("#compdef ", app.get_name(), "\n");
  ZshFunction({&app}, FunctionName(app), &text);
  // Autoloaded: the file is the body of the function.
  absl::StrAppend(&text, FunctionName(app), " \"$@\"\n");
  return text;
}

}  // namespace homing
