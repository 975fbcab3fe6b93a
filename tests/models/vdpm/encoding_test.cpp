#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>

#include <varifold/base/bytes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/vdpm/encoding.h>
#include <cstring>

namespace varifold::test {
namespace {

using Bytes = std::vector<std::byte>;

// All that the functions of a model tell of its steps.
std::vector<std::uint32_t> steps_of(const ViewDependentMesh& model) {
  std::vector<std::uint32_t> words(model.watch_roots().begin(), model.watch_roots().end());
  for (std::uint32_t k = 0; k < model.step_count(); ++k) {
    const StepBounds b = model.bounds(k);
    words.insert(words.end(), {b.vertex, b.cone, b.radius, b.nested_radius, b.mu, b.delta,
                               b.nested_error, b.nested_angle});
    model.for_each_required(k, [&](std::uint32_t r) { words.push_back(r); });
    model.for_each_watched(k, [&](std::uint32_t w) { words.push_back(w); });
    model.for_each_changed(k, [&](std::uint32_t t, std::uint32_t c, std::uint32_t v) {
      words.insert(words.end(), {t, c, v});
    });
    model.for_each_added(k, [&](std::uint32_t t, const std::array<std::uint32_t, 3>& corners) {
      words.insert(words.end(), {t, corners[0], corners[1], corners[2]});
    });
  }
  return words;
}

TEST(VdpmEncoding, IsTheIdentity) {
  for (const NamedVdpm& named : all_vdpms()) {
    const Bytes bytes = encode_view_dependent_mesh(*named.model);
    const auto decoded = decode_view_dependent_mesh(bytes);
    ASSERT_TRUE(decoded) << named.name << ": " << decoded.error().message;
    EXPECT_EQ(encode_view_dependent_mesh(*decoded), bytes) << named.name;
    EXPECT_EQ(decoded->bytes(), named.model->bytes()) << named.name;
    EXPECT_EQ(steps_of(*decoded), steps_of(*named.model)) << named.name;
    EXPECT_EQ(decoded->attributes().ranges, named.detailed.mesh.ranges) << named.name;
    ViewDependentInstance instance(std::make_shared<ViewDependentMesh>(*decoded));
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      instance.go_to_level(level);
      const TriangleMesh expected = mesh_at_level(named.detailed, level);
      ASSERT_EQ(mesh_difference(instance.extract(), expected), "") << named.name;
      ASSERT_EQ(decoded->error(level), named.model->error(level)) << named.name;
    }
  }
}

// An error of one line with an offset, or a model whose steps may come in any order that its
// requirements allow. Returns whether it was a model.
bool expect_fault_or_model(const std::string& name, std::span<const std::byte> bytes,
                           std::uint64_t seed) {
  const auto decoded = decode_view_dependent_mesh(bytes);
  if (!decoded) {
    EXPECT_EQ(decoded.error().kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(decoded.error().message.rfind("byte ", 0), 0u) << decoded.error().message;
    EXPECT_EQ(decoded.error().message.find('\n'), std::string::npos);
    return false;
  }
  const auto model = std::make_shared<ViewDependentMesh>(*decoded);
  ViewDependentInstance instance(model);
  const std::uint32_t finest = decoded->finest_level();
  for (const std::uint32_t level : {0u, finest, finest / 2}) {
    instance.go_to_level(level);
    const TriangleMesh mesh = instance.extract();
    EXPECT_EQ(mesh.triangle_count(), decoded->triangle_count(level)) << name;
    for (const Fault& fault : validate(mesh, 1))
      EXPECT_NE(fault.severity, Severity::kBroken) << name << ": " << fault.kind;
  }
  ActiveSurface surface(*model);
  RandomWalk walk(*model, seed);
  for (const double upwards : {0.9, 0.4, 0.8}) {
    walk.walk(surface, finest, upwards);
    for (const Fault& fault : validate(surface.extract(), 1))
      EXPECT_NE(fault.severity, Severity::kBroken) << name << ": " << fault.kind;
    const DrawList list = surface.draw_list();
    for (const std::uint32_t v : list.indices) EXPECT_LT(v, list.positions.size()) << name;
  }
  return true;
}

std::vector<const NamedVdpm*> small_vdpms(std::uint32_t levels) {
  std::vector<const NamedVdpm*> small;
  for (const NamedVdpm& named : all_vdpms())
    if (named.model->finest_level() <= levels) small.push_back(&named);
  return small;
}

TEST(VdpmEncoding, EveryTruncationIsRefused) {
  for (const NamedVdpm* named : small_vdpms(60)) {
    const Bytes bytes = encode_view_dependent_mesh(*named->model);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_FALSE(decode_view_dependent_mesh(std::span(bytes).first(size))) << named->name;
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(decode_view_dependent_mesh(longer)) << named->name;
  }
}

TEST(VdpmEncoding, DamagedBytesAreRefusedOrHarmless) {
  Random random(9);
  std::uint32_t refused = 0, accepted = 0;
  for (const NamedVdpm* named : small_vdpms(400)) {
    const Bytes bytes = encode_view_dependent_mesh(*named->model);
    for (int i = 0; i < 100; ++i) {
      Bytes damaged = bytes;
      const std::uint32_t faults = 1 + random.below(3);
      for (std::uint32_t j = 0; j < faults; ++j) {
        const std::uint32_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
        damaged[at] = static_cast<std::byte>(random.next());
        // Whole words near what they were are the ones that get furthest.
        if (random.below(2) == 0 && at + 4 <= bytes.size())
          store_little(damaged.data() + at,
                       load<std::uint32_t>(bytes.data() + at) + 1 - 2 * random.below(2));
      }
      const bool is_model = expect_fault_or_model(named->name, damaged, random.next());
      ++(is_model ? accepted : refused);
    }
  }
  EXPECT_GT(refused, 500u);
  EXPECT_GT(accepted, 500u);
}

}  // namespace
}  // namespace varifold::test
