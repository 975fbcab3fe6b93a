#include <gtest/gtest.h>

#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/validation.h>
#include <cmath>
#include <limits>
#include <map>

namespace varifold {
namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();

const Fault* find(const std::vector<Fault>& faults, const std::string& kind) {
  for (const Fault& fault : faults)
    if (fault.kind == kind) return &fault;
  return nullptr;
}

void expect_only(const TriangleMesh& mesh, const std::string& kind, Severity severity,
                 std::uint64_t count, const std::string& where) {
  const std::vector<Fault> faults = validate(mesh);
  ASSERT_EQ(faults.size(), 1u) << kind;
  EXPECT_EQ(faults[0].kind, kind);
  EXPECT_EQ(faults[0].severity, severity);
  EXPECT_EQ(faults[0].count, count);
  EXPECT_EQ(faults[0].where, where);
  EXPECT_EQ(is_sound(faults), severity == Severity::kNote);
}

TEST(Validate, ClosedManifoldsHaveNothing) {
  for (const auto& [name, mesh] : test::group_closed()) EXPECT_TRUE(validate(mesh).empty()) << name;
  EXPECT_TRUE(validate({}).empty());
}

TEST(Validate, EveryGeneratedMeshIsSound) {
  for (const std::string_view name : generator_names())
    EXPECT_TRUE(is_sound(validate(generate(name, {.triangles = 3000}).value()))) << name;
}

TEST(Validate, OpenMeshesHaveANote) {
  expect_only(test::grid(1, 1), "boundary_edge", Severity::kNote, 4, "edge 0-1, 0-2, 1-3, 2-3");
}

TEST(Validate, WrongArraySizes) {
  TriangleMesh mesh = test::cube();
  mesh.normals.assign(7, Vec3(0, 0, 1));
  expect_only(mesh, "wrong_array_size", Severity::kBroken, 1, "7 normals for 8 positions");
}

TEST(Validate, Indices) {
  TriangleMesh mesh = test::cube();
  mesh.indices.pop_back();
  expect_only(mesh, "incomplete_triangle", Severity::kBroken, 1, "35 indices");
  mesh = test::cube();
  mesh.indices[7] = 8;
  mesh.indices[35] = kNone;
  expect_only(mesh, "index_out_of_range", Severity::kBroken, 2, "triangle 2, 11");
}

TEST(Validate, MaterialRanges) {
  TriangleMesh mesh = test::cube();
  mesh.materials.resize(2);
  mesh.ranges = {{0, 0, 6}, {1, 6, 6}};
  EXPECT_TRUE(validate(mesh).empty());
  mesh.ranges = {{0, 0, 6}, {1, 7, 5}};
  expect_only(mesh, "bad_material_range", Severity::kBroken, 1, "range 1");
  mesh.ranges = {{0, 0, 6}, {0, 6, 6}};
  expect_only(mesh, "bad_material_range", Severity::kBroken, 1, "range 1");
  mesh.ranges = {{2, 0, 12}};
  expect_only(mesh, "bad_material_range", Severity::kBroken, 1, "range 0");
  mesh.ranges = {{0, 0, kNone}};
  expect_only(mesh, "bad_material_range", Severity::kBroken, 1,
              "ranges end at triangle 4294967295 of 12");
  mesh.ranges.clear();
  mesh.materials[1].textures[0] = 0;
  expect_only(mesh, "bad_texture_index", Severity::kBroken, 1, "material 1");
}

TEST(Validate, NonFiniteValues) {
  TriangleMesh mesh = test::cube();
  mesh.positions[3].y = kNan;
  expect_only(mesh, "nonfinite_position", Severity::kBroken, 1, "vertex 3");
  mesh = test::cube();
  mesh.normals.assign(8, Vec3(0, 0, 1));
  mesh.normals[2].x = std::numeric_limits<float>::infinity();
  expect_only(mesh, "nonfinite_normal", Severity::kFault, 1, "vertex 2");
  mesh.normals[2] = Vec3(0);
  expect_only(mesh, "zero_normal", Severity::kFault, 1, "vertex 2");
  mesh.normals[2] = Vec3(0, 2, 0);
  expect_only(mesh, "unnormalized_normal", Severity::kNote, 1, "vertex 2");
  mesh.normals.clear();
  mesh.texcoords.assign(8, Vec2(0));
  mesh.texcoords[7].y = kNan;
  expect_only(mesh, "nonfinite_texcoord", Severity::kFault, 1, "vertex 7");
}

TEST(Validate, NonmanifoldMeshesAreUnsound) {
  for (const auto& [name, mesh] : test::group_nonmanifold()) {
    const std::vector<Fault> faults = validate(mesh);
    EXPECT_FALSE(is_sound(faults)) << name;
    EXPECT_TRUE(find(faults, "nonmanifold_vertex")) << name;
  }
}

TEST(Validate, PlacesAreNamedByTheFirstVertexAtThePosition) {
  // Three squares around an edge, all vertices separate.
  const TriangleMesh mesh = test::make_mesh({{0, 0, 0},
                                             {0, 0, 1},
                                             {1, 0, 0},
                                             {9, 9, 9},
                                             {0, 0, 0},
                                             {0, 0, 1},
                                             {-1, 1, 0},
                                             {0, 0, 0},
                                             {0, 0, 1},
                                             {-1, -1, 0}},
                                            {0, 1, 2, 4, 5, 6, 7, 8, 9});
  const std::vector<Fault> faults = validate(mesh);
  ASSERT_TRUE(find(faults, "nonmanifold_edge"));
  EXPECT_EQ(find(faults, "nonmanifold_edge")->where, "edge 0-1");
  EXPECT_EQ(find(faults, "nonmanifold_vertex")->where, "vertex 0, 1");
  EXPECT_EQ(find(faults, "boundary_edge")->where, "edge 0-2, 0-6, 0-9, 1-2, 1-6, ...");
  EXPECT_EQ(find(faults, "boundary_edge")->count, 6u);
  EXPECT_EQ(find(faults, "unused_vertex")->where, "vertex 3");
}

TEST(Validate, Defects) {
  const std::map<std::string, const char*> kinds{
      {"unused_vertices", "unused_vertex"},        {"duplicates", "duplicate_triangle"},
      {"repeated_corners", "degenerate_triangle"}, {"collapsed_by_position", "degenerate_triangle"},
      {"one_triangle_turned", "misoriented_edge"}, {"moebius_strip", "misoriented_edge"}};
  for (const auto& [name, mesh] : test::group_defects()) {
    SCOPED_TRACE(name);
    const std::vector<Fault> faults = validate(mesh);
    EXPECT_EQ(is_sound(faults), name == "unused_vertices");
    if (kinds.count(name) != 0) {
      EXPECT_TRUE(find(faults, kinds.at(name)));
    }
  }
}

TEST(Validate, TrianglesOnALineAreANote) {
  const TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2});
  const std::vector<Fault> faults = validate(mesh);
  ASSERT_TRUE(find(faults, "zero_area_triangle"));
  EXPECT_TRUE(is_sound(faults));
}

TEST(Validate, SameForAnyNumberOfThreads) {
  const TriangleMesh mesh = test::soup(60'000, 100'000, 9);
  const std::vector<Fault> one = validate(mesh, 1), many = validate(mesh, 3);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].kind, many[i].kind);
    EXPECT_EQ(one[i].count, many[i].count);
    EXPECT_EQ(one[i].where, many[i].where);
  }
}

TEST(CountFlipped, NoneOfAMeshAgainstItself) {
  for (auto group : {test::group_closed, test::group_open, test::group_seams})
    for (const auto& [name, mesh] : group()) EXPECT_EQ(count_flipped(mesh, mesh), 0u) << name;
}

TEST(CountFlipped, AllOfAMeshTurnedInsideOut) {
  const TriangleMesh mesh = test::icosphere(500);
  TriangleMesh turned = mesh;
  for (std::size_t i = 0; i < turned.indices.size(); i += 3)
    std::swap(turned.indices[i], turned.indices[i + 1]);
  EXPECT_EQ(count_flipped(turned, mesh), turned.triangle_count());
}

TEST(CountFlipped, OneFoldedTriangle) {
  // Of a flat grid: the triangle on vertices 0, 1, 5 turned round, others as they were.
  const TriangleMesh mesh = test::grid(3, 3);
  TriangleMesh folded = mesh;
  std::swap(folded.indices[3], folded.indices[4]);
  EXPECT_EQ(flipped_triangles(folded, mesh), (std::vector<std::uint32_t>{1}));
}

TEST(CountFlipped, UnknownPositionsAreNotJudged) {
  const TriangleMesh mesh = test::grid(1, 1);
  TriangleMesh moved = mesh;
  std::swap(moved.indices[0], moved.indices[1]);
  for (Vec3& p : moved.positions) p.z = 1;
  EXPECT_EQ(count_flipped(moved, mesh), 0u);
  EXPECT_EQ(count_flipped(moved, {}), 0u);
  EXPECT_EQ(count_flipped({}, mesh), 0u);
}

}  // namespace
}  // namespace varifold
