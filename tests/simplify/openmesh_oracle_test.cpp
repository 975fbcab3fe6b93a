// OpenMesh as a judge that shares no code: it takes only faces that keep a surface manifold.
#include <gtest/gtest.h>

#include <tests/simplify/sequence_checks.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/weld.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace varifold {
namespace {

using Judge = OpenMesh::TriMesh_ArrayKernelT<>;

struct Verdict {
  std::size_t refused_faces = 0;
  std::size_t border_edges = 0;
  long euler = 0;
};

Verdict judge(const TriangleMesh& mesh) {
  const WeldMap weld = weld_exact(mesh.positions);
  Judge judge;
  std::vector<Judge::VertexHandle> handles(weld.class_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    Judge::VertexHandle& handle = handles[weld.class_of[v]];
    if (handle.is_valid()) continue;
    const Vec3& p = mesh.positions[v];
    handle = judge.add_vertex({p.x, p.y, p.z});
  }
  Verdict verdict;
  omerr().disable();  // its complaints are counted, not printed
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return handles[weld.class_of[mesh.indices[i + k]]]; };
    if (!judge.add_face(corner(0), corner(1), corner(2)).is_valid()) ++verdict.refused_faces;
  }
  std::size_t used = 0;
  for (const auto v : judge.vertices()) used += judge.is_isolated(v) ? 0 : 1;
  for (const auto e : judge.edges()) verdict.border_edges += judge.is_boundary(e);
  verdict.euler = static_cast<long>(used) - static_cast<long>(judge.n_edges()) +
                  static_cast<long>(judge.n_faces());
  return verdict;
}

TEST(OpenMeshOracle, TakesEveryLevelOfManifoldMeshes) {
  std::vector<test::NamedMesh> meshes = test::group_closed();
  for (auto& named : test::group_open()) meshes.push_back(std::move(named));
  for (auto& named : test::group_seams()) meshes.push_back(std::move(named));
  for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
    for (const test::NamedMesh& named : meshes) {
      SCOPED_TRACE(named.name);
      SimplifyOptions options;
      options.placement = placement;
      const auto result = simplify(named.mesh, options);
      const Verdict full = judge(result->detailed.mesh);
      for (const std::uint32_t level : test::spread_levels(result->detailed.sequence, 30)) {
        const Verdict verdict = judge(mesh_at_level(result->detailed, level));
        ASSERT_EQ(verdict.refused_faces, 0u) << "level " << level;
        ASSERT_EQ(verdict.euler, full.euler) << "level " << level;
        ASSERT_EQ(verdict.border_edges > 0, full.border_edges > 0) << "level " << level;
      }
    }
  }
}

}  // namespace
}  // namespace varifold
