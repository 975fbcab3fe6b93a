// What the fuzz targets of decoders of models share: what is accepted can be drawn at any level,
// depends on the level alone, and gives itself when it is encoded and decoded again.
#pragma once

#include <fuzz/fuzz_support.h>
#include <varifold/io/any_model.h>
#include <algorithm>
#include <memory>
#include <vector>

namespace varifold::fuzz {

template <class Model>
void check_model(std::span<const std::byte> input) {
  using Kind = ModelKind<Model>;
  auto decoded = Kind::decode(input);
  if (!decoded) {
    const std::string& message = decoded.error().message;
    require(!message.empty() && message.find('\n') == std::string::npos);
    return;
  }
  const auto encoded = Kind::encode(*decoded);
  const auto again = Kind::decode(encoded);
  require(again && Kind::encode(*again) == encoded);

  const auto model = std::make_shared<const Model>(std::move(*decoded));
  const std::uint32_t finest = model->finest_level();
  InstanceOf<Model> walker(model);
  std::vector<std::vector<std::uint32_t>> shown;
  const std::uint32_t levels[] = {finest, finest / 2, finest / 3, 0};
  for (const std::uint32_t level : levels) {
    walker.go_to_level(level);
    const TriangleMesh mesh = walker.extract();
    check(Result<ImportedMesh>(ImportedMesh{mesh, {}}));
    if constexpr (requires { walker.frame(); })
      require(mesh.vertex_count() == walker.vertex_count());  // the model's is that of all frames
    else
      require(mesh.vertex_count() == model->vertex_count(level));
    const DrawList list = walker.draw_list();
    for (const DrawRange& range : list.ranges)
      require(std::uint64_t{range.first_index} + range.index_count <= list.indices.size());
    shown.emplace_back(list.indices.begin(), list.indices.end());
  }
  for (std::size_t i = std::size(levels); i-- > 0;) {
    walker.go_to_level(levels[i]);
    const DrawList list = walker.draw_list();
    require(std::equal(shown[i].begin(), shown[i].end(), list.indices.begin(), list.indices.end()));
  }
}

}  // namespace varifold::fuzz
