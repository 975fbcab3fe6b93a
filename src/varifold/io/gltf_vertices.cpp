#include <varifold/io/gltf_vertices.h>

#include <fmt/format.h>
#include <varifold/io/import_check.h>
#include <algorithm>
#include <cmath>

namespace varifold::gltf {
namespace {

constexpr Color kWhite{255, 255, 255, 255};

/// Room for `count` more values; at least doubles, so that many small additions stay linear.
template <class T>
void reserve_more(std::vector<T>& values, std::size_t count) {
  const std::size_t needed = values.size() + count;
  if (needed > values.capacity()) values.reserve(std::max(needed, 2 * values.capacity()));
}

Color to_color(const float* values, unsigned components) {
  Color color = kWhite;
  for (unsigned i = 0; i < components; ++i) color[static_cast<int>(i)] = color_byte(values[i]);
  return color;
}

bool is_of_joints(const std::string& attribute) {
  return attribute.starts_with("JOINTS_") || attribute.starts_with("WEIGHTS_");
}

}  // namespace

VertexReader::Key VertexReader::key_of(const JsonElement& primitive) {
  const JsonElement attributes = primitive.object("attributes");
  Key key;
  for (const char* name : kAttributes) key.push_back(attributes.whole(name, kNone));
  for (const std::string& name : attributes.keys()) {
    if (is_of_joints(name))
      key.push_back(attributes.whole(name));
    else if (std::find(kAttributes.begin(), kAttributes.end(), name) == kAttributes.end())
      dropped_attributes_.insert(name);
  }
  const JsonElement targets = primitive.array("targets");
  for (std::size_t i = 0; i < targets.size(); ++i)
    for (const char* name : {"POSITION", "NORMAL"})
      key.push_back(targets.item(i).whole(name, kNone));
  return key;
}

VertexBlock VertexReader::read(const JsonElement& primitive, const Placement& placement) {
  const JsonElement attributes = primitive.object("attributes");
  const auto first = static_cast<std::uint32_t>(imported_.mesh.positions.size());
  Values values;
  std::size_t count = 0;
  unsigned color_components = 4;
  for (std::size_t i = 0; i < kAttributes.size(); ++i) {
    if (!attributes.has(kAttributes[i])) continue;
    const Accessor accessor = buffers_.accessor(attributes.whole(kAttributes[i]));
    if (fault_.any()) return {};
    check_attribute(attributes, i, accessor);
    if (i == 0) count = accessor.elements.count;
    if (accessor.elements.count != count)
      attributes.fault(fmt::format("{} has {} elements, POSITION has {}", kAttributes[i],
                                   accessor.elements.count, count));
    spend(attributes, count * accessor.components * sizeof(float));
    if (fault_.any()) return {};
    if (i == 3) color_components = accessor.components;
    values[i] = decode_floats(accessor);
  }
  if (first + count >= kNone) {
    attributes.fault("more vertices than 32 bits can count", ErrorKind::kUnsupported);
    return {};
  }
  append(values, count, color_components, placement.mover);
  append_joints(attributes, count, placement.binding);
  targets_.read(primitive, placement.poses, first, count, values[1], placement.mover);
  return {first, static_cast<std::uint32_t>(count)};
}

void VertexReader::spend(const JsonElement& element, std::size_t bytes) {
  if (!budget_.spend(bytes))
    element.fault("the instances of the meshes take many times the size of the file",
                  ErrorKind::kUnsupported);
}

void VertexReader::check_attribute(const JsonElement& attributes, std::size_t attribute,
                                   const Accessor& accessor) {
  static constexpr std::array<unsigned, kAttributes.size()> kComponents{3, 3, 2, 4};
  const bool fits =
      accessor.components == kComponents[attribute] || (attribute == 3 && accessor.components == 3);
  if (!fits)
    attributes.fault(
        fmt::format("{} has {} components", kAttributes[attribute], accessor.components));
  if (accessor.elements.type == ComponentType::kUint32)
    attributes.fault(fmt::format("{} has components of 32-bit integers", kAttributes[attribute]));
}

void VertexReader::append(const Values& values, std::size_t count, unsigned color_components,
                          const Mover& mover) {
  TriangleMesh& mesh = imported_.mesh;
  const std::size_t first = mesh.positions.size();
  const auto& [positions, normals, texcoords, colors] = values;
  reserve_more(mesh.positions, count);
  for (std::size_t i = 0; i < count; ++i)
    mesh.positions.push_back(
        mover.point({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}));
  if (!normals.empty()) {
    mesh.normals.resize(first, Vec3(0));
    for (std::size_t i = 0; i < count; ++i)
      mesh.normals.push_back(
          mover.normal({normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]}));
  } else if (count > 0) {
    without_normals_.push_back(
        {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
  }
  if (!texcoords.empty()) {
    mesh.texcoords.resize(first, Vec2(0));
    for (std::size_t i = 0; i < count; ++i)
      mesh.texcoords.emplace_back(texcoords[2 * i], texcoords[2 * i + 1]);
  }
  if (!colors.empty()) {
    colors_not_finite_ += static_cast<std::size_t>(std::count_if(
        colors.begin(), colors.end(), [](float value) { return !std::isfinite(value); }));
    mesh.colors.resize(first, kWhite);
    for (std::size_t i = 0; i < count; ++i)
      mesh.colors.push_back(to_color(&colors[color_components * i], color_components));
  }
}

void VertexReader::append_joints(const JsonElement& attributes, std::size_t count,
                                 const JointBinding& binding) {
  std::vector<JointWeights>& skin = imported_.mesh.skin;
  if (binding.kind == JointBinding::Kind::kNone) {
    for (const std::string& name : attributes.keys())
      if (is_of_joints(name)) dropped_attributes_.insert(name);
    return;
  }
  if (binding.kind == JointBinding::Kind::kOneJoint) {
    spend(attributes, count * sizeof(JointWeights));
    if (fault_.any()) return;
    skin.resize(skin.size() + count, {{binding.joint, 0, 0, 0}, {1, 0, 0, 0}});
    return;
  }
  const std::vector<JointWeights> joints =
      read_joint_weights(attributes, count, binding.joints, buffers_, budget_, repairs_);
  skin.insert(skin.end(), joints.begin(), joints.end());
}

void VertexReader::finish() {
  TriangleMesh& mesh = imported_.mesh;
  const std::size_t count = mesh.positions.size();
  if (mesh.has_texcoords()) mesh.texcoords.resize(count, Vec2(0));
  if (mesh.has_colors()) mesh.colors.resize(count, kWhite);
  if (mesh.has_normals()) mesh.normals.resize(count, Vec3(0));
  fill_normals();
  targets_.make_poses(mesh);
  for (const std::string& name : dropped_attributes_)
    imported_.warnings.push_back("attribute " + in_quotes(name) + " was dropped");
  warn_count(imported_, colors_not_finite_, "components of colours that are not finite became 0");
  repairs_.warn(imported_);
}

void VertexReader::fill_normals() {
  TriangleMesh& mesh = imported_.mesh;
  if (!mesh.has_normals() || without_normals_.empty()) return;
  std::vector<bool> is_missing(mesh.positions.size(), false);
  std::size_t missing = 0;
  for (const VertexBlock& block : without_normals_) {
    std::fill_n(is_missing.begin() + block.first, block.count, true);
    missing += block.count;
  }
  fill_missing_normals(mesh, is_missing);
  warn_count(imported_, missing, "vertices without normal got that of their triangles");
}

}  // namespace varifold::gltf
