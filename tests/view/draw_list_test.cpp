#include <gtest/gtest.h>

#include <varifold/view/draw_list.h>
#include <vector>

namespace varifold {
namespace {

TEST(DrawList, CountsTrianglesOfListsAndStrips) {
  const std::vector<std::uint32_t> indices = {0,
                                              1,
                                              2,
                                              2,
                                              1,
                                              3,  // two triangles
                                              0,
                                              1,
                                              2,
                                              3,
                                              kStripRestart,
                                              4,
                                              5,
                                              6,  // 2 + 1
                                              kStripRestart,
                                              7,
                                              8,
                                              kStripRestart,
                                              9};  // none
  const std::vector<DrawRange> ranges = {{0, 6, Primitive::kTriangles, 0, 1},
                                         {6, 13, Primitive::kStrips, 1, 1}};
  DrawList list;
  list.indices = indices;
  list.ranges = ranges;
  EXPECT_EQ(submitted_triangles(list), 5u);
  EXPECT_EQ(submitted_triangles(DrawList{}), 0u);
  const SubmittedIndices sent = submitted_indices(list);
  EXPECT_EQ(sent.indices, 19u);
  EXPECT_EQ(sent.vertices, 16u);
  EXPECT_EQ(sent.strips, 4u);
  EXPECT_EQ(submitted_indices(DrawList{}).indices, 0u);
}

}  // namespace
}  // namespace varifold
