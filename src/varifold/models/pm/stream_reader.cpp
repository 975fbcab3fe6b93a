#include <varifold/models/pm/stream_reader.h>

#include <varifold/models/common/error_code.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/pm/slot_order.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>
#include <string>

namespace varifold {

namespace {

constexpr std::uint32_t kLastSlot = ProgressiveMeshData::kLastSlot;
constexpr std::uint32_t kNoSlot = ProgressiveMeshData::kNoSlot;

constexpr std::size_t kLongRecord = 512;  // bytes

Error fault_at(std::size_t byte, const std::string& what) {
  return {ErrorKind::kInvalidInput, "byte " + std::to_string(byte) + ": " + what};
}

}  // namespace

Result<void> ProgressiveStreamReader::refuse(Error error) {
  fault_ = std::move(error);
  faulty_ = true;
  pending_.clear();
  return tl::unexpected<Error>(fault_);
}

Result<void> ProgressiveStreamReader::push(std::span<const std::byte> bytes) {
  if (faulty_) return tl::unexpected<Error>(fault_);
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  std::size_t used = 0;
  while (stage_ != Stage::kSplits && pending_.size() - used >= section_size()) {
    const auto size = static_cast<std::size_t>(section_size());
    if (auto read = read_section(std::span(pending_).subspan(used, size)); !read)
      return refuse(read.error());
    offset_ += size;
    used += size;
    stage_ = static_cast<Stage>(static_cast<int>(stage_) + 1);
  }
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(used));
  if (stage_ != Stage::kSplits || pending_.size() < try_at_) return {};
  return read_splits();
}

std::uint64_t ProgressiveStreamReader::section_size() const {
  switch (stage_) {
    case Stage::kPreamble:
      return pm::StreamPreamble::kSize;
    case Stage::kHeader:
      return preamble_.header_size;
    case Stage::kImages:
      return preamble_.images_size;
    default:
      return preamble_.base_size;
  }
}

Result<void> ProgressiveStreamReader::read_section(std::span<const std::byte> section) {
  switch (stage_) {
    case Stage::kPreamble:
      return pm::read_preamble(section).map(
          [&](const pm::StreamPreamble& preamble) { preamble_ = preamble; });
    case Stage::kHeader:
      return pm::read_header(section, offset_).map([&](pm::StreamHeader&& header) {
        header_ = std::move(header);
        data_.mesh.materials = header_.materials;
      });
    case Stage::kImages: {
      auto images = read_images(section, offset_);
      if (!images) return tl::unexpected<Error>(images.error());
      data_.mesh.images = std::move(*images);
      for (const Material& material : header_.materials)
        for (const std::uint32_t image : material.textures)
          if (image != kNone && image >= data_.mesh.images.size())
            return tl::unexpected<Error>(fault_at(offset_, "a material names an image beyond"));
      return {};
    }
    default:
      return read_base(section);
  }
}

namespace {

// The vertices of the base, each as the difference to the one before.
bool read_base_vertices(BitReader& bits, std::uint32_t count, pm::StreamState& state,
                        TriangleMesh& mesh) {
  const pm::AttributeCoder& coder = state.coder;
  pm::CodeModels models;
  pm::Codes codes{};
  coder.resize(mesh, count);
  for (std::uint32_t v = 0; v < count; ++v) {
    const pm::Prediction prediction = coder.predict_next(codes);
    for (std::uint32_t c = 0; c < coder.channel_count(); ++c) {
      RiceModel& model = models.model[prediction.model[c]];
      const std::uint32_t value = model.read(bits);
      model.update(value);
      codes[c] += unzigzag(value);
    }
    if (!coder.decode(codes, mesh, v)) return false;
    state.table.insert(state.table.end(), codes.begin(), codes.begin() + coder.channel_count());
  }
  state.surface.add_vertices(count);
  return true;
}

bool read_base_triangles(BitReader& bits, const pm::StreamHeader& header,
                         pm::SplitSurface& surface) {
  for (std::uint32_t range = 0; range < header.ranges.size(); ++range) {
    for (std::uint32_t i = 0; i < header.ranges[range].base_triangles; ++i) {
      pm::NewTriangle triangle;
      triangle.range = range;
      for (std::uint32_t& corner : triangle.corners) corner = bits.uniform(header.base_vertices);
      const auto& [a, b, c] = triangle.corners;
      if (a == b || b == c || a == c) return false;
      surface.add_triangle(triangle);
    }
  }
  return true;
}

}  // namespace

Result<void> ProgressiveStreamReader::read_base(std::span<const std::byte> section) {
  state_.coder = pm::AttributeCoder(header_.format);
  state_.surface = pm::SplitSurface(static_cast<std::uint32_t>(header_.ranges.size()));
  state_.error = header_.error;
  state_.moves_vertices = header_.moves_vertices;
  const std::uint64_t section_bits = 8 * std::uint64_t{section.size()};
  const std::uint64_t least_bits =
      std::uint64_t{header_.base_vertices} * state_.coder.channel_count() +
      3 * std::uint64_t{header_.base_triangles};
  if (least_bits > section_bits || (header_.base_triangles > 0 && header_.base_vertices < 3))
    return tl::unexpected<Error>(fault_at(offset_, "the base has no room for its triangles"));

  reserve(pending_.size());
  BitReader bits(section);
  const bool good = read_base_vertices(bits, header_.base_vertices, state_, data_.mesh) &&
                    read_base_triangles(bits, header_, state_.surface);
  if (bits.exhausted())
    return tl::unexpected<Error>(fault_at(offset_ + section.size(), "the base ends too early"));
  if (!good)
    return tl::unexpected<Error>(
        fault_at(offset_ + bits.position() / 8, "a vertex or triangle of the base is damaged"));
  if ((bits.position() + 7) / 8 != section.size())
    return tl::unexpected<Error>(fault_at(offset_, "the base is too long"));

  data_.base_vertices = header_.base_vertices;
  data_.base_triangles = header_.base_triangles;
  data_.target.assign(header_.base_vertices, kNone);
  data_.error.assign(1, error_of_code(header_.error));
  data_.error_is_measured = header_.error_is_measured;
  if (header_.ranges.size() > 1)
    data_.triangle_level.assign(state_.surface.corners().size() / 3, 0);
  if (header_.moves_vertices) {
    data_.first_placed.assign(1, 0);
    latest_placed_.assign(header_.base_vertices, kNone);
  }
  return {};
}

// Room for what may stand in so many bytes: a split takes one at least; the header has no say in
// more than that.
void ProgressiveStreamReader::reserve(std::size_t bytes) {
  const std::size_t splits = std::min<std::size_t>(header_.levels, bytes);
  const std::size_t vertices =
      std::min<std::size_t>(header_.vertices, header_.base_vertices + bytes);
  const std::size_t triangles =
      std::min<std::size_t>(header_.triangles, header_.base_triangles + 2 * bytes);
  state_.surface.reserve(vertices, triangles);
  state_.table.reserve(vertices * state_.coder.channel_count());
  data_.mesh.positions.reserve(vertices + 1);
  data_.target.reserve(vertices);
  data_.slots.reserve(4 * vertices);
  data_.splits.reserve(splits);
  data_.error.reserve(splits + 1);
}

Result<void> ProgressiveStreamReader::read_splits() {
  const std::uint32_t last = std::min(header_.levels, last_level_);
  BitReader bits(pending_, first_bit_);
  std::size_t position = first_bit_;
  for (; level() < last; position = bits.position()) {
    const char* fault = record_reader_.read(state_, bits, record_);
    if (bits.exhausted()) break;
    if (fault == nullptr && !take_record()) fault = "a vertex lies outside of its grid";
    if (fault == nullptr && triangle_count() > header_.triangles) fault = "too many triangles";
    if (fault != nullptr) return refuse(fault_at(offset_ + position / 8, fault));
  }
  const auto whole = static_cast<std::ptrdiff_t>(position / 8);
  pending_.erase(pending_.begin(), pending_.begin() + whole);
  offset_ += position / 8;
  first_bit_ = position % 8;
  // Long records are not tried again for every byte that arrives.
  try_at_ = pending_.size() + (pending_.size() < kLongRecord ? 1 : pending_.size() / 8);
  if (level() == header_.levels) return check_end();
  if (level() >= last_level_) pending_.clear();
  return {};
}

// Behind the last split there is nothing but zeros that fill its last byte.
Result<void> ProgressiveStreamReader::check_end() {
  try_at_ = 0;
  const std::size_t last_byte = first_bit_ > 0 ? 1 : 0;
  if (pending_.size() > last_byte)
    return refuse(fault_at(offset_ + last_byte, "there are bytes behind the last split"));
  if (last_byte > 0 && std::to_integer<unsigned>(pending_[0]) >> first_bit_ != 0)
    return refuse(fault_at(offset_, "the last bits are not zero"));
  if (vertex_count() != header_.vertices || triangle_count() != header_.triangles)
    return refuse(fault_at(offset_, "the splits do not add up to the whole mesh"));
  return {};
}

namespace {

template <class T>
void append_one(const std::vector<T>& from, std::uint32_t index, std::vector<T>& to) {
  if (!from.empty()) to.push_back(from[index]);
}

}  // namespace

// Enters record_ into the model; false where a vertex cannot be, and then nothing is changed.
bool ProgressiveStreamReader::take_record() {
  const std::uint32_t vertices = vertex_count();
  const auto wedges = static_cast<std::uint32_t>(record_.wedges.size());
  const auto placed = static_cast<std::uint32_t>(record_.placed_vertices.size());
  const pm::AttributeCoder& coder = state_.coder;
  coder.resize(data_.mesh, std::size_t{vertices} + wedges + placed);
  bool good = true;
  for (std::uint32_t i = 0; i < wedges; ++i)
    good &= coder.decode(record_.codes[i], data_.mesh, vertices + i);
  for (std::uint32_t i = 0; i < placed; ++i)
    good &= coder.decode(record_.placed_codes[i], data_.mesh, vertices + wedges + i);
  if (!good) {
    coder.resize(data_.mesh, vertices);
    return false;
  }

  if (state_.moves_vertices) take_placed(vertices + wedges);
  coder.resize(data_.mesh, std::size_t{vertices} + wedges);
  const std::size_t first_slot = data_.slots.size();
  for (const pm::SplitWedge& wedge : record_.wedges) {
    data_.target.push_back(wedge.target);
    data_.slots.insert(data_.slots.end(), record_.moved.begin() + wedge.first_moved,
                       record_.moved.begin() + wedge.end_moved);
    if (wedge.first_moved == wedge.end_moved && wedges > 1) data_.slots.push_back(kNoSlot);
    if (data_.slots.size() > first_slot) data_.slots.back() |= kLastSlot;
  }
  data_.splits.push_back({static_cast<std::uint16_t>(data_.slots.size() - first_slot),
                          static_cast<std::uint8_t>(wedges),
                          static_cast<std::uint8_t>(record_.triangles.size())});
  state_.apply(record_);
  data_.error.push_back(error_of_code(state_.error));
  if (header_.ranges.size() > 1) {
    data_.triangle_level.resize(state_.surface.corners().size() / 3);
    for (const std::uint32_t triangle : state_.surface.added())
      data_.triangle_level[triangle] = level();
  }
  return true;
}

// The new attributes of the placed vertices stand from `first_new` on in the vertex arrays.
void ProgressiveStreamReader::take_placed(std::uint32_t first_new) {
  TriangleMesh& mesh = data_.mesh;
  latest_placed_.resize(first_new, kNone);
  for (std::uint32_t i = 0; i < record_.placed_vertices.size(); ++i) {
    const std::uint32_t vertex = record_.placed_vertices[i];
    const auto j = static_cast<std::uint32_t>(data_.placed_vertex.size());
    append_one(mesh.positions, vertex, data_.placed.positions);
    append_one(mesh.normals, vertex, data_.placed.normals);
    append_one(mesh.texcoords, vertex, data_.placed.texcoords);
    append_one(mesh.colors, vertex, data_.placed.colors);
    data_.placed_vertex.push_back(vertex);
    data_.finer.push_back(kNone);
    if (latest_placed_[vertex] != kNone) data_.finer[latest_placed_[vertex]] = j;
    latest_placed_[vertex] = j;
    mesh.positions[vertex] = mesh.positions[first_new + i];
    if (mesh.has_normals()) mesh.normals[vertex] = mesh.normals[first_new + i];
    if (mesh.has_texcoords()) mesh.texcoords[vertex] = mesh.texcoords[first_new + i];
    if (mesh.has_colors()) mesh.colors[vertex] = mesh.colors[first_new + i];
  }
  data_.first_placed.push_back(static_cast<std::uint32_t>(data_.placed_vertex.size()));
}

DrawList ProgressiveStreamReader::draw_list() {
  if (!has_base()) return {};
  const float fraction =
      header_.levels > 0 ? static_cast<float>(level()) / static_cast<float>(header_.levels) : 1;
  draw_ranges_.clear();
  for (std::uint32_t r = 0; r < header_.ranges.size(); ++r)
    for (const auto& block : state_.surface.blocks(r))
      draw_ranges_.push_back({3 * block.first, 3 * block.count, Primitive::kTriangles,
                              header_.ranges[r].material, fraction});
  const std::vector<std::uint32_t>& corners = state_.surface.corners();
  changed_ = {{0, vertex_count()}, {0, static_cast<std::uint32_t>(corners.size())}};
  DrawList list = draw_vertices(data_.mesh);
  list.indices = corners;
  list.ranges = draw_ranges_;
  list.changed_vertices = std::span(changed_).first(1);
  list.changed_indices = std::span(changed_).last(1);
  return list;
}

TriangleMesh ProgressiveStreamReader::extract() const {
  TriangleMesh mesh = data_.mesh;
  if (!has_base()) return mesh;
  const std::vector<std::uint32_t>& corners = state_.surface.corners();
  for (std::uint32_t r = 0; r < header_.ranges.size(); ++r) {
    MaterialRange range{header_.ranges[r].material, mesh.triangle_count(), 0};
    for (const auto& block : state_.surface.blocks(r)) {
      const auto first = corners.begin() + 3 * std::ptrdiff_t{block.first};
      mesh.indices.insert(mesh.indices.end(), first, first + 3 * std::ptrdiff_t{block.count});
      range.triangle_count += block.count;
    }
    if (header_.has_ranges && range.triangle_count > 0) mesh.ranges.push_back(range);
  }
  return mesh;
}

Result<ProgressiveMesh> ProgressiveStreamReader::finish() && {
  if (!faulty_ && stage_ != Stage::kSplits)
    return tl::unexpected<Error>(
        fault_at(offset_ + pending_.size(), "the bytes end before the base mesh does"));
  if (!faulty_ && level() < std::min(header_.levels, last_level_))
    if (auto read = read_splits(); !read) return tl::unexpected<Error>(read.error());
  if (faulty_) return tl::unexpected<Error>(fault_);
  undo_splits();
  if (header_.ranges.size() > 1)
    sort_triangles_by_range();
  else if (header_.has_ranges && triangle_count() > 0)
    data_.mesh.ranges = {{header_.ranges[0].material, 0, triangle_count()}};
  return ProgressiveMesh(std::move(data_));
}

// The index buffer as it is at level 0, with every later triangle as it appears.
void ProgressiveStreamReader::undo_splits() {
  std::vector<std::uint32_t>& indices = data_.mesh.indices;
  indices = state_.surface.take_corners();
  if (header_.ranges.size() == 1) indices.resize(3 * std::size_t{triangle_count()});
  std::uint32_t vertex = vertex_count();
  std::size_t slot = data_.slots.size();
  for (std::size_t k = data_.splits.size(); k-- > 0;) {
    const VertexSplit split = data_.splits[k];
    // Backwards: the flag says that the slots of the vertex before begin.
    for (std::uint32_t i = 0, of = vertex; i < split.slots; ++i) {
      const std::uint32_t entry = data_.slots[--slot];
      if ((entry & kLastSlot) != 0) --of;
      if ((entry & ~kLastSlot) != kNoSlot) indices[entry & ~kLastSlot] = data_.target[of];
    }
    vertex -= split.vertices;
  }
}

void ProgressiveStreamReader::sort_triangles_by_range() {
  std::vector<std::uint32_t> indices, levels;
  std::vector<std::uint32_t> new_id(data_.triangle_level.size(), kNone);
  std::uint32_t next = 0;
  for (std::uint32_t r = 0; r < header_.ranges.size(); ++r) {
    MaterialRange range{header_.ranges[r].material, next, 0};
    for (const auto& block : state_.surface.blocks(r)) {
      for (std::uint32_t t = block.first; t < block.first + block.count; ++t) {
        new_id[t] = next++;
        levels.push_back(data_.triangle_level[t]);
        for (std::size_t c = 0; c < 3; ++c)
          indices.push_back(data_.mesh.indices[3 * std::size_t{t} + c]);
      }
    }
    range.triangle_count = next - range.first_triangle;
    if (range.triangle_count > 0) data_.mesh.ranges.push_back(range);
  }
  data_.mesh.indices = std::move(indices);
  data_.triangle_level = std::move(levels);
  if (data_.mesh.ranges.size() <= 1) data_.triangle_level.clear();
  for (std::uint32_t& entry : data_.slots) {
    const std::uint32_t slot = entry & ~kLastSlot;
    if (slot != kNoSlot) entry = (entry & kLastSlot) | (3 * new_id[slot / 3] + slot % 3);
  }
  sort_slots(data_.slots);
}

}  // namespace varifold
