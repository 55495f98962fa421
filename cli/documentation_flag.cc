#include "cli/documentation_flag.h"

#include <utility>

#include "cli/completion.h"

namespace homing {
namespace {

std::string Render(const CLI::App& app, const ManPage& page, const std::string& form) {
  std::string text = form == "man"    ? ToManPage(app, page)
                     : form == "bash" ? ToBashCompletion(app)
                                      : ToZshCompletion(app);
  // CLI11 ends the text with a line end.
  text.pop_back();
  return text;
}

}  // namespace

void AddDocumentationFlag(CLI::App& app, ManPage page) {
  app.add_option_function<std::string>(
         "--documentation",
         [&app, page = std::move(page)](const std::string& form) {
           throw CLI::CallForVersion(Render(app, page, form), 0);
         },
         "Print the man page or a completion script")
      ->check(CLI::IsMember({"man", "bash", "zsh"}))
      ->trigger_on_parse()
      ->group("");
}

}  // namespace homing
