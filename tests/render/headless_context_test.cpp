#include <gtest/gtest.h>

#include <stdlib.h>
#include <unistd.h>

#include <tests/support/test_files.h>
#include <varifold/render/headless_context.h>
#include <varifold/render/renderer.h>
#include <cstdio>
#include <utility>

namespace varifold {
namespace {

/// Ends this process with 0 when there is no context and the error reads well, and prints it.
[[noreturn]] void expect_no_context() {
  const auto context = HeadlessContext::create();
  if (context) _exit(1);
  std::fprintf(stderr, "%s\n", context.error().message.c_str());
  const bool one_line = context.error().message.find('\n') == std::string::npos;
  _exit(one_line && context.error().kind == ErrorKind::kFailed ? 0 : 2);
}

TEST(HeadlessContext, SaysWhatDrawsAndMoves) {
  auto context = HeadlessContext::create();
  if (!context) GTEST_SKIP() << context.error().message;
  EXPECT_NE(context->description().find("OpenGL 4."), std::string::npos);
  const HeadlessContext moved = std::move(*context);
  EXPECT_TRUE(moved.make_current());
  EXPECT_TRUE(Renderer::create());
}

TEST(HeadlessContext, SeveralLiveSideBySide) {
  const auto first = HeadlessContext::create();
  if (!first) GTEST_SKIP() << first.error().message;
  {
    const auto second = HeadlessContext::create({.software = true});
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_TRUE(second->make_current());
  }
  EXPECT_TRUE(first->make_current()) << "the end of the second leaves the first alone";
  EXPECT_TRUE(Renderer::create());
}

// The statement runs in a fresh process, before anything has loaded EGL.
TEST(HeadlessContextDeathTest, WithoutAnyEglVendorItIsAnError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const test::TemporaryFolder empty;
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_DIRS", empty.file("").c_str(), 1);
        expect_no_context();
      },
      ::testing::ExitedWithCode(0), "no EGL display");
}

TEST(HeadlessContextDeathTest, WithoutAnyDriverItIsAnError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const test::TemporaryFolder empty;
  EXPECT_EXIT(
      {
        setenv("LIBGL_DRIVERS_PATH", empty.file("").c_str(), 1);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        expect_no_context();
      },
      ::testing::ExitedWithCode(0), "no OpenGL without a window");
}

TEST(RendererDeathTest, WithoutAContextItIsAnError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(_exit(Renderer::create() ? 1 : 0), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace varifold
