#include <benchmarks/bench_meshes.h>

#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/generators.h>
#include <cstdint>
#include <cstdio>
#include <map>
#include <utility>

namespace varifold::bench {

namespace {

constexpr std::uint32_t kPlanetTriangles = 1'300'000;

TriangleMesh load(const std::string& name) {
  if (name.starts_with("planet")) {
    PlanetOptions options;
    options.triangles = kPlanetTriangles;
    options.colors_by_height = name == "planet_attributes";
    TriangleMesh mesh = planet(options);
    return options.colors_by_height ? mesh : without_attributes(mesh);
  }
  const auto path = test::real_mesh(name);
  if (!path) return {};
  auto imported = read_mesh(*path);
  if (!imported) {
    std::fprintf(stderr, "%s\n", imported.error().message.c_str());
    return {};
  }
  return std::move(imported->mesh);
}

}  // namespace

const TriangleMesh& mesh(const std::string& name) {
  static std::map<std::string, TriangleMesh> loaded;
  const auto found = loaded.find(name);
  return found != loaded.end() ? found->second : loaded.emplace(name, load(name)).first->second;
}

std::vector<std::string> present(const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  for (const std::string& name : wanted)
    if (name.starts_with("planet") || test::real_mesh(name)) names.push_back(name);
  return names;
}

TriangleMesh without_attributes(const TriangleMesh& mesh) {
  TriangleMesh plain;
  plain.positions = mesh.positions;
  plain.indices = mesh.indices;
  return plain;
}

}  // namespace varifold::bench
