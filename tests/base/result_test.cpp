#include <gtest/gtest.h>

#include <varifold/base/progress.h>
#include <varifold/base/result.h>

namespace varifold {
namespace {

Result<int> half(int x) {
  if (x % 2 != 0) return fail(ErrorKind::kInvalidInput, "odd");
  return x / 2;
}

TEST(Result, CarriesAValueOrAnError) {
  EXPECT_EQ(half(4).value(), 2);
  const Result<int> bad = half(3);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().kind, ErrorKind::kInvalidInput);
  const Result<int> wrapped = fail_in("a.obj", bad.error());
  EXPECT_EQ(wrapped.error().message, "a.obj: odd");
  EXPECT_EQ(wrapped.error().kind, ErrorKind::kInvalidInput);
}

TEST(Progress, AnEmptyCallbackNeverCancels) {
  EXPECT_TRUE(report({}, "stage", 0.5f));
  EXPECT_FALSE(report([](std::string_view, float) { return false; }, "stage", 0.5f));
}

}  // namespace
}  // namespace varifold
