#include <gtest/gtest.h>
#include <tests/models/lodstrips/static_support.h>
#include <tests/strip/oriented_triangles.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/vertex_arrays.h>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace varifold {
namespace {

using test::draw;
using test::NamedSequence;

template <class Kind>
class StaticForm : public ::testing::Test {
 protected:
  using Form = typename Kind::Form;
  using Cursor = typename Kind::Cursor;

  static Form build(const NamedSequence& sequence, const StripifyOptions& options = {}) {
    return Kind::build(sequence.detailed, stripify(sequence.detailed.mesh, options));
  }
  static Cursor cursor(const Form& form, const NamedSequence& sequence) {
    return Cursor(form, sequence.table, sequence.detailed.mesh);
  }
  // What is drawn is the level as it is defined.
  static void expect_level(Cursor& cursor, const NamedSequence& sequence, std::uint32_t level) {
    const TriangleMesh& attributes = sequence.detailed.mesh;
    const std::uint32_t vertices = sequence.table.vertex_count(level);
    ASSERT_EQ(cursor.level(), level);
    const DrawList list = draw(cursor, attributes);
    for (const DrawRange& range : list.ranges)
      for (const std::uint32_t v : list.indices.subspan(range.first_index, range.index_count))
        ASSERT_LT(v, vertices) << sequence.name << " level " << level;
    ASSERT_EQ(test::oriented_triangles(extract_level(attributes, vertices, list)),
              test::oriented_triangles(mesh_at_level(sequence.detailed, level)))
        << sequence.name << " level " << level;
  }
  static Result<Form> take(std::span<const std::byte> bytes, const NamedSequence& sequence) {
    SectionReader section(bytes, 100);
    auto form = Form::take(section, sequence.table,
                           static_cast<std::uint32_t>(sequence.detailed.mesh.ranges.size()));
    if (form && !section.at_end()) return section.fault("bytes are left");
    return form;
  }
  static std::vector<std::byte> bytes_of(const Form& form) {
    std::vector<std::byte> bytes;
    form.append_bytes(bytes);
    return bytes;
  }
};

using Kinds = ::testing::Types<test::Thesis, test::Grouped>;
TYPED_TEST_SUITE(StaticForm, Kinds);

TYPED_TEST(StaticForm, DrawsEveryLevelOnTheWayDownAndUp) {
  for (const NamedSequence& sequence : test::all_sequences()) {
    for (const StripifyOptions& options : test::some_options()) {
      const auto form = this->build(sequence, options);
      auto cursor = this->cursor(form, sequence);
      auto levels = test::spread_levels(sequence.table.finest_level());
      for (const std::uint32_t level : levels) {
        cursor.go_to_level(level);
        this->expect_level(cursor, sequence, level);
      }
      std::reverse(levels.begin(), levels.end());
      for (const std::uint32_t level : levels) {
        cursor.go_to_level(level);
        this->expect_level(cursor, sequence, level);
      }
      if (this->HasFatalFailure()) return;
    }
  }
}

TYPED_TEST(StaticForm, BytesDependOnTheLevelAlone) {
  Random random(11);
  for (const NamedSequence& sequence : test::all_sequences()) {
    const auto form = this->build(sequence);
    auto wanderer = this->cursor(form, sequence);
    for (int i = 0; i < 12; ++i) {
      const std::uint32_t level = random.below(sequence.table.finest_level() + 1);
      auto fresh = this->cursor(form, sequence);
      fresh.go_to_level(level);
      wanderer.go_to_level(level);
      const DrawList a = draw(fresh, sequence.detailed.mesh);
      const DrawList b = draw(wanderer, sequence.detailed.mesh);
      ASSERT_TRUE(
          std::equal(a.indices.begin(), a.indices.end(), b.indices.begin(), b.indices.end()))
          << sequence.name << " level " << level;
      ASSERT_EQ(a.ranges.size(), b.ranges.size());
      for (std::size_t r = 0; r < a.ranges.size(); ++r) {
        EXPECT_EQ(a.ranges[r].first_index, b.ranges[r].first_index);
        EXPECT_EQ(a.ranges[r].index_count, b.ranges[r].index_count);
        EXPECT_EQ(a.ranges[r].material, b.ranges[r].material);
      }
    }
    wanderer.go_to_level(sequence.table.finest_level());
    const DrawList full = draw(wanderer, sequence.detailed.mesh);
    EXPECT_TRUE(std::equal(full.indices.begin(), full.indices.end(), form.strips.indices.begin(),
                           form.strips.indices.end()));
  }
}

TYPED_TEST(StaticForm, ChangedIndicesAreAllThatChanged) {
  Random random(5);
  for (const NamedSequence& sequence : test::all_sequences()) {
    const auto form = this->build(sequence);
    auto cursor = this->cursor(form, sequence);
    std::vector<std::uint32_t> uploaded(form.strips.indices.size(), 12345);
    for (int i = 0; i < 10; ++i) {
      cursor.go_to_level(random.below(sequence.table.finest_level() + 1));
      const DrawList list = draw(cursor, sequence.detailed.mesh);
      for (const ElementRange& range : list.changed_indices)
        std::copy_n(list.indices.begin() + range.first, range.count,
                    uploaded.begin() + range.first);
      ASSERT_TRUE(
          std::equal(uploaded.begin(), uploaded.end(), list.indices.begin(), list.indices.end()))
          << sequence.name;
    }
    EXPECT_TRUE(draw(cursor, sequence.detailed.mesh).changed_indices.empty());
  }
}

TYPED_TEST(StaticForm, BytesThereAndBack) {
  for (const NamedSequence& sequence : test::all_sequences()) {
    const auto bytes = this->bytes_of(this->build(sequence));
    const auto form = this->take(bytes, sequence);
    ASSERT_TRUE(form) << sequence.name << ": " << form.error().message;
    EXPECT_EQ(this->bytes_of(*form), bytes) << sequence.name;
  }
}

TYPED_TEST(StaticForm, EveryTruncationIsFound) {
  for (const NamedSequence& sequence : test::all_sequences()) {
    const auto bytes = this->bytes_of(this->build(sequence));
    const std::size_t step = 1 + bytes.size() / 300;
    for (std::size_t size = 0; size < bytes.size(); size += step) {
      const auto form = this->take(std::span(bytes).first(size), sequence);
      ASSERT_FALSE(form) << sequence.name << " " << size;
      EXPECT_EQ(form.error().kind, ErrorKind::kInvalidInput);
      EXPECT_EQ(form.error().message.find("byte "), 0u);
    }
  }
}

// Whatever passes the checks can be walked: down, up, at random; and drawn within bounds.
TYPED_TEST(StaticForm, DamagedBytesAreRefusedOrHarmless) {
  Random random(17);
  std::uint32_t refused = 0, harmless = 0;
  for (const NamedSequence& sequence : test::all_sequences()) {
    const auto bytes = this->bytes_of(this->build(sequence));
    for (int run = 0; run < 60; ++run) {
      auto damaged = bytes;
      for (std::uint32_t i = 0; i < 1 + random.below(3) && !damaged.empty(); ++i) {
        std::byte& byte = damaged[random.below(static_cast<std::uint32_t>(damaged.size()))];
        byte = run % 2 == 0 ? byte ^ static_cast<std::byte>(1u << random.below(8))
                            : static_cast<std::byte>(random.below(256));
      }
      const auto form = this->take(damaged, sequence);
      ++(form ? harmless : refused);
      if (!form) continue;
      auto cursor = this->cursor(*form, sequence);
      const std::uint32_t finest = sequence.table.finest_level();
      for (const std::uint32_t level : {0u, finest / 2, finest / 3, finest}) {
        cursor.go_to_level(level);
        const DrawList list = draw(cursor, sequence.detailed.mesh);
        for (const DrawRange& range : list.ranges)
          for (const std::uint32_t v : list.indices.subspan(range.first_index, range.index_count))
            ASSERT_LT(v, sequence.table.vertex_count(level));
      }
      const DrawList list = draw(cursor, sequence.detailed.mesh);
      EXPECT_TRUE(std::equal(list.indices.begin(), list.indices.end(), form->strips.indices.begin(),
                             form->strips.indices.end()));
    }
  }
  EXPECT_GT(refused, 1000u);
  EXPECT_GT(harmless, 0u);
}

TYPED_TEST(StaticForm, VeryLongStripsAreCut) {
  NamedSequence sequence;
  sequence.detailed.mesh = test::grid(40000, 1);
  sequence.detailed.sequence.vertices = {sequence.detailed.mesh.vertex_count()};
  sequence.detailed.sequence.triangles = {sequence.detailed.mesh.triangle_count()};
  sequence.detailed.sequence.error = {0};
  sequence.detailed.sequence.triangle_level.assign(sequence.detailed.mesh.triangle_count(), 0);
  sequence.detailed.sequence.target.assign(sequence.detailed.mesh.vertex_count(), kNone);
  sequence.table = LevelTable(sequence.detailed.sequence);
  ASSERT_EQ(stripify(sequence.detailed.mesh).count(), 1u);
  const auto form = this->build(sequence);
  EXPECT_EQ(form.strips.count(), 2u);
  EXPECT_TRUE(this->take(this->bytes_of(form), sequence));
  auto cursor = this->cursor(form, sequence);
  this->expect_level(cursor, sequence, 0);
}

// Models of meshes with vertices of several wedges have steps that move several of them.
TYPED_TEST(StaticForm, SeamsThatEndInsideTheSurface) {
  for (const char* name : {"CesiumMan.glb", "DamagedHelmet.glb"}) {
    VARIFOLD_REAL_MESH_OR_SKIP(path, name);
    const auto imported = read_mesh(path);
    ASSERT_TRUE(imported);
    const NamedSequence sequence = test::make_sequence(name, imported->mesh);
    const auto form = this->build(sequence);
    auto cursor = this->cursor(form, sequence);
    for (const std::uint32_t level : test::spread_levels(sequence.table.finest_level())) {
      cursor.go_to_level(level);
      this->expect_level(cursor, sequence, level);
    }
    const auto taken = this->take(this->bytes_of(form), sequence);
    EXPECT_TRUE(taken) << taken.error().message;
  }
}

TEST(GroupedCursor, ArraysForMultiDraw) {
  const NamedSequence sequence = test::make_sequence("sphere", test::icosphere(720));
  const GroupedForm form = build_grouped_form(sequence.detailed, stripify(sequence.detailed.mesh));
  GroupedCursor cursor(form, sequence.table, sequence.detailed.mesh);
  cursor.go_to_level(sequence.table.finest_level() / 4);
  const DrawList list = draw(cursor, sequence.detailed.mesh);
  // Ranges have an order of their own.
  std::map<std::size_t, std::uint32_t> ranges;
  for (const DrawRange& range : list.ranges)
    ranges[range.first_index * sizeof(std::uint32_t)] = range.index_count;
  std::size_t drawn = 0;
  for (std::size_t s = 0; s < form.strips.count(); ++s) {
    EXPECT_EQ(cursor.offsets()[s], form.strips.first[s] * sizeof(std::uint32_t));
    if (cursor.counts()[s] == 0) continue;
    ASSERT_TRUE(ranges.contains(cursor.offsets()[s]));
    EXPECT_EQ(ranges[cursor.offsets()[s]], static_cast<std::uint32_t>(cursor.counts()[s]));
    ++drawn;
  }
  EXPECT_EQ(drawn, list.ranges.size());
  EXPECT_LT(drawn, form.strips.count());
}

TEST(StaticFormSizes, AreThoseOfTheThesisAndBetter) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "bunny.ply");
  const auto imported = read_mesh(path);
  ASSERT_TRUE(imported);
  const NamedSequence sequence = test::make_sequence("bunny", imported->mesh);
  const TriangleStrips strips =
      stripify(sequence.detailed.mesh, {.max_indices = kStaticStripIndices});
  const double vertices = sequence.detailed.mesh.vertex_count();
  const double shared =
      vertex_bytes(sequence.detailed.mesh) / vertices + sequence.table.bytes() / vertices;
  const double thesis = shared + build_thesis_form(sequence.detailed, strips).bytes() / vertices;
  const double grouped = shared + build_grouped_form(sequence.detailed, strips).bytes() / vertices;
  EXPECT_LE(thesis, 86);
  EXPECT_LE(grouped, 66);
  EXPECT_LE(grouped, 0.77 * thesis);
}

}  // namespace
}  // namespace varifold
