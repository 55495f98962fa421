#include "server/base/read_window.h"

#include <gtest/gtest.h>

#include "server/base/inline_policy.h"

namespace homing::server {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(ReadWindowTest, IsFullAtItsNumberOfRequests) {
  ReadWindow window;
  EXPECT_TRUE(window.IsEmpty());
  window.Add(10);
  window.Add(10);
  EXPECT_FALSE(window.IsFull(0, 3));
  EXPECT_TRUE(window.IsFull(0, 2));
  // An answer that was not sent yet counts like a request.
  EXPECT_TRUE(window.IsFull(1, 3));
  window.MarkAnswered();
  EXPECT_FALSE(window.IsFull(0, 2));
}

TEST(ReadWindowTest, IsFullAtItsBytes) {
  ReadWindow window;
  window.Add(ReadWindow::kMaxBytes - 1);
  EXPECT_FALSE(window.IsFull(0, ReadWindow::kMaxRequests));
  window.Add(1);
  EXPECT_TRUE(window.IsFull(0, ReadWindow::kMaxRequests));
  // The oldest is answered first.
  window.MarkAnswered();
  EXPECT_FALSE(window.IsFull(0, ReadWindow::kMaxRequests));
}

TEST(ReadWindowTest, AnAnswerWithoutARequestChangesNothing) {
  ReadWindow window;
  window.MarkAnswered();
  EXPECT_TRUE(window.IsEmpty());
  EXPECT_FALSE(window.IsFull(0, 1));
}

TEST(InlinePolicyTest, SmallRequestsOfAQuickStreamRunInline) {
  InlinePolicy policy;
  EXPECT_FALSE(policy.RunsInline(1));
  policy.NoteHandled(microseconds(10));
  EXPECT_TRUE(policy.RunsInline(InlinePolicy::kInlineBytes));
  EXPECT_FALSE(policy.RunsInline(InlinePolicy::kInlineBytes + 1));
  policy.NoteHandled(milliseconds(2));
  EXPECT_FALSE(policy.RunsInline(1));
}

TEST(InlinePolicyTest, TheSecondLongWaitInARowCounts) {
  InlinePolicy policy;
  EXPECT_FALSE(policy.NoteWait(milliseconds(6)));
  EXPECT_TRUE(policy.NoteWait(milliseconds(6)));
  EXPECT_FALSE(policy.NoteWait(milliseconds(1)));
  EXPECT_FALSE(policy.NoteWait(milliseconds(6)));
}

}  // namespace
}  // namespace homing::server
