#include <varifold/io/gltf_skin_weights.h>

#include <fmt/format.h>
#include <varifold/io/import_check.h>
#include <algorithm>
#include <cmath>

namespace varifold::gltf {
namespace {

struct Influence {
  std::uint32_t joint;  ///< of the skin
  float weight;
};

bool is_joint_type(ComponentType type) {
  return type == ComponentType::kUint8 || type == ComponentType::kUint16;
}

bool is_weight_type(const Accessor& accessor) {
  const ComponentType type = accessor.elements.type;
  return type == ComponentType::kFloat32 || (accessor.normalized && is_joint_type(type));
}

/// All influences of all vertices, 4 a set, in the order of vertices.
class InfluenceReader {
 public:
  InfluenceReader(const JsonElement& attributes, std::size_t count, BufferStore& buffers,
                  Budget& budget)
      : attributes_(attributes), count_(count), buffers_(buffers), budget_(budget) {}

  /// False after a fault.
  bool read(std::size_t sets, std::vector<Influence>& influences) {
    constexpr std::size_t kBytes = 4 * (3 * sizeof(std::uint32_t) + sizeof(Influence));
    if (!budget_.spend(sets * count_ * kBytes)) {
      attributes_.fault("the joints take many times the size of the file", ErrorKind::kUnsupported);
      return false;
    }
    influences.resize(4 * sets * count_);
    for (std::size_t set = 0; set < sets; ++set) {
      const Accessor joints = accessor(fmt::format("JOINTS_{}", set));
      const Accessor weights = accessor(fmt::format("WEIGHTS_{}", set));
      if (is_bad_) return false;
      if (!is_joint_type(joints.elements.type) || !is_weight_type(weights)) {
        attributes_.fault(fmt::format("JOINTS_{0} or WEIGHTS_{0} have another type", set));
        return false;
      }
      const std::vector<float> indices = decode_floats(joints);
      const std::vector<float> values = decode_floats(weights);
      for (std::size_t i = 0; i < 4 * count_; ++i)
        influences[4 * sets * (i / 4) + 4 * set + i % 4] = {static_cast<std::uint32_t>(indices[i]),
                                                            values[i]};
    }
    return true;
  }

 private:
  Accessor accessor(const std::string& name) {
    if (!attributes_.has(name)) return refuse(name + " is missing");
    Accessor accessor = buffers_.accessor(attributes_.whole(name));
    // Without a fault there are elements of a known kind.
    if (accessor.components != 4) return refuse(name + " does not have 4 components");
    if (accessor.elements.count != count_)
      return refuse(fmt::format("{} has {} elements, POSITION has {}", name,
                                accessor.elements.count, count_));
    accessor.normalized = accessor.normalized && name[0] == 'W';
    return accessor;
  }
  Accessor refuse(const std::string& fault) {
    attributes_.fault(fault);
    is_bad_ = true;
    return {};
  }

  const JsonElement& attributes_;
  std::size_t count_;
  BufferStore& buffers_;
  Budget& budget_;
  bool is_bad_ = false;
};

/// The heaviest four, of equal ones the first, in their order; all where there are no more.
void keep_heaviest(std::vector<Influence>& influences, SkinWeightRepairs& repairs) {
  for (Influence& influence : influences)
    if (!std::isfinite(influence.weight) || influence.weight <= 0) influence = {0, 0};
  if (influences.size() <= 4) return;
  std::erase_if(influences, [](const Influence& i) { return i.weight == 0; });
  if (influences.size() > 4) ++repairs.reduced;
  while (influences.size() > 4) {
    const auto lightest = std::min_element(
        influences.rbegin(), influences.rend(),
        [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
    influences.erase(std::next(lightest).base());
  }
}

}  // namespace

std::vector<JointWeights> read_joint_weights(const JsonElement& attributes, std::size_t count,
                                             std::span<const std::uint16_t> joints,
                                             BufferStore& buffers, Budget& budget,
                                             SkinWeightRepairs& repairs) {
  std::size_t sets = 1;
  while (attributes.has(fmt::format("JOINTS_{}", sets))) ++sets;
  std::vector<Influence> influences;
  if (!InfluenceReader(attributes, count, buffers, budget).read(sets, influences)) return {};

  std::vector<JointWeights> result(count);
  std::vector<Influence> own;
  for (std::size_t v = 0; v < count; ++v) {
    const auto first = influences.begin() + static_cast<std::ptrdiff_t>(4 * sets * v);
    own.assign(first, first + static_cast<std::ptrdiff_t>(4 * sets));
    const std::uint32_t leading = own[0].joint;
    keep_heaviest(own, repairs);
    double sum = 0;
    for (const Influence& influence : own) sum += influence.weight;
    if (sum == 0) {
      ++repairs.unweighted;
      own.assign(1, {leading, 1});
      sum = 1;
    }
    // Exporters round; what is nearer than that to 1 stays bit by bit.
    constexpr double kRoundings = 1e-6;
    constexpr double kNotable = 1e-3;
    const bool is_off = !(std::abs(sum - 1) <= kRoundings);
    if (!(std::abs(sum - 1) <= kNotable)) ++repairs.normalized;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (own[i].weight == 0) continue;
      if (own[i].joint >= joints.size()) {
        attributes.fault(
            fmt::format("vertex {} follows joint {} of {}", v, own[i].joint, joints.size()));
        return {};
      }
      result[v].joints[i] = joints[own[i].joint];
      result[v].weights[i] = is_off ? static_cast<float>(own[i].weight / sum) : own[i].weight;
    }
  }
  return result;
}

void SkinWeightRepairs::warn(ImportedMesh& imported) const {
  warn_count(imported, reduced, "vertices follow more than four joints, of which four were kept");
  warn_count(imported, normalized, "vertices had weights of joints that do not sum up to 1");
  warn_count(imported, unweighted, "vertices without weights follow their first joint");
}

}  // namespace varifold::gltf
