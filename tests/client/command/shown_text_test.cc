#include "client/command/shown_text.h"

#include <gtest/gtest.h>

#include <string>

namespace homing::client {
namespace {

TEST(ShownTextTest, KeepsTextInAnyLanguage) {
  for (const char* text : {"", "robots/r1: 3 steps\n\tand more", "Weg nach Hause, 5 €, Übung",
                           "家へ", "…–“”", "\xF0\x9F\xA4\x96"}) {
    EXPECT_EQ(ShownText(text), text);
  }
}

TEST(ShownTextTest, CommandsToATerminalAreWritten) {
  EXPECT_EQ(ShownText("a\x1b]0;title\x07\x1b[2Jb\r"), "a\\u001b]0;title\\u0007\\u001b[2Jb\\u000d");
  EXPECT_EQ(ShownText("\x7f\b"), "\\u007f\\u0008");
  // The 8-bit form of the escape.
  EXPECT_EQ(ShownText("\xC2\x9B"
                      "31m"),
            "\\u009b31m");
}

TEST(ShownTextTest, TheDirectionOfWritingStays) {
  EXPECT_EQ(ShownText("a\u202eb\u2066c\u200f"), "a\\u202eb\\u2066c\\u200f");
}

TEST(ShownTextTest, CutUtf8StaysAsItIs) {
  for (const char* text : {"\xC2", "\xE2", "\xE2\x80", "\xFF\xFE", "\x9B"}) {
    EXPECT_EQ(ShownText(text), text);
  }
}

}  // namespace
}  // namespace homing::client
