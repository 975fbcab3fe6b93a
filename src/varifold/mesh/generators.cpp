#include <varifold/mesh/generators.h>
#include <array>
#include <string>

namespace varifold {

namespace {

using Generator = TriangleMesh (*)(const GeneratorOptions&);

struct NamedGenerator {
  std::string_view name;
  Generator generator;
};

/// Passes the common options on to a shape that has options of its own.
template <class Options, TriangleMesh (*kShape)(const Options&)>
TriangleMesh with_defaults(const GeneratorOptions& options) {
  Options all;
  static_cast<GeneratorOptions&>(all) = options;
  return kShape(all);
}

constexpr std::array kGenerators{
    NamedGenerator{"planet", with_defaults<PlanetOptions, planet>},
    NamedGenerator{"terrain", with_defaults<TerrainOptions, terrain>},
    NamedGenerator{"sphere", sphere},
    NamedGenerator{"torus", torus},
    NamedGenerator{"knot", with_defaults<KnotOptions, knot>},
    NamedGenerator{"plane", plane},
    NamedGenerator{"box", box},
    NamedGenerator{"seamed_sphere", seamed_sphere},
};

constexpr auto kNames = [] {
  std::array<std::string_view, kGenerators.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kGenerators[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> generator_names() { return kNames; }

Result<TriangleMesh> generate(std::string_view shape, const GeneratorOptions& options) {
  if (options.triangles == 0 || options.triangles > kMaxGeneratedTriangles)
    return fail(ErrorKind::kInvalidInput, "the number of triangles must be between 1 and " +
                                              std::to_string(kMaxGeneratedTriangles));
  for (const NamedGenerator& entry : kGenerators)
    if (entry.name == shape) return entry.generator(options);

  std::string message = "unknown shape '" + std::string(shape) + "'; there are";
  for (const std::string_view name : kNames) message.append(" ").append(name);
  return fail(ErrorKind::kInvalidInput, message);
}

}  // namespace varifold
