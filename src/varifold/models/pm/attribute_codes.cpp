#include <varifold/models/pm/attribute_codes.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace varifold::pm {

namespace {

// Floats as unsigned numbers of the same order; a bijection, so that nothing is lost.
std::uint32_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}

float unordered(std::uint32_t code) {
  return std::bit_cast<float>(code >> 31 ? code & 0x7fffffffu : ~code);
}

std::uint32_t ordered_or_zero(double value) {
  const auto rounded = static_cast<float>(value);
  return ordered(std::isfinite(rounded) ? rounded : 0.0f);
}

std::uint32_t to_grid(double value, double origin, double step, int bits) {
  const double last = static_cast<double>((1u << bits) - 1);
  const double place = step > 0 ? std::floor((value - origin) / step + 0.5) : 0;
  return place > 0 ? static_cast<std::uint32_t>(std::min(place, last)) : 0;
}

float from_grid(std::uint32_t code, double origin, double step) {
  return static_cast<float>(origin + step * static_cast<double>(code));
}

// The octahedron |x| + |y| + |z| = radius, its lower half folded outwards over the square.
struct Octahedron {
  int radius;

  explicit Octahedron(int bits) : radius((1 << (bits - 1)) - 1) {}

  [[nodiscard]] std::array<int, 3> point(std::uint32_t code_x, std::uint32_t code_y) const {
    const int x = static_cast<int>(code_x) - radius, y = static_cast<int>(code_y) - radius;
    const int z = radius - std::abs(x) - std::abs(y);
    if (z >= 0) return {x, y, z};
    return {x < 0 ? std::abs(y) - radius : radius - std::abs(y),
            y < 0 ? std::abs(x) - radius : radius - std::abs(x), z};
  }

  // The codes of a direction; (0, 0, 1) where there is none.
  template <class T>
  [[nodiscard]] std::array<std::uint32_t, 2> codes(T x, T y, T z) const {
    const double sum = static_cast<double>(std::abs(x) + std::abs(y) + std::abs(z));
    if (!(sum > 0) || sum > 1e300) return {center(), center()};
    double u = static_cast<double>(x) / sum, v = static_cast<double>(y) / sum;
    if (z < 0) {
      const double folded = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
      v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
      u = folded;
    }
    return {place(u), place(v)};
  }

 private:
  [[nodiscard]] std::uint32_t center() const { return static_cast<std::uint32_t>(radius); }
  [[nodiscard]] std::uint32_t place(double unit) const {
    return static_cast<std::uint32_t>(
        std::clamp(std::floor((unit + 1) * radius + 0.5), 0.0, 2.0 * radius));
  }
};

bool decode_position(const AttributeFormat& format, const std::uint32_t* codes, Vec3& position) {
  for (int axis = 0; axis < 3; ++axis) {
    if (format.position_bits == 0) {
      position[axis] = unordered(codes[axis]);
    } else {
      if (codes[axis] >> format.position_bits != 0) return false;
      position[axis] = from_grid(codes[axis], static_cast<double>(format.position_origin[axis]),
                                 format.position_step);
    }
    if (!std::isfinite(position[axis])) return false;
  }
  return true;
}

bool decode_normal(const AttributeFormat& format, const std::uint32_t* codes, Vec3& normal) {
  if (format.normal_bits == 0) {
    normal = Vec3(unordered(codes[0]), unordered(codes[1]), unordered(codes[2]));
    return true;
  }
  const Octahedron octahedron(format.normal_bits);
  const auto last = static_cast<std::uint32_t>(2 * octahedron.radius);
  if (codes[0] > last || codes[1] > last) return false;
  const std::array<int, 3> point = octahedron.point(codes[0], codes[1]);
  const DVec3 direction(point[0], point[1], point[2]);
  normal = Vec3(direction / std::sqrt(glm::dot(direction, direction)));
  return true;
}

bool decode_texcoord(const AttributeFormat& format, const std::uint32_t* codes, Vec2& texcoord) {
  for (int axis = 0; axis < 2; ++axis) {
    if (format.texcoord_bits == 0) {
      texcoord[axis] = unordered(codes[axis]);
      continue;
    }
    if (codes[axis] >> format.texcoord_bits != 0) return false;
    texcoord[axis] = from_grid(codes[axis], static_cast<double>(format.texcoord_origin[axis]),
                               format.texcoord_step[static_cast<std::size_t>(axis)]);
  }
  return true;
}

std::uint32_t distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

std::uint16_t model_of(Field field, std::uint32_t scale) {
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(field) * CodeModels::kScales +
                                    static_cast<std::uint32_t>(std::bit_width(scale)));
}

}  // namespace

CodeModels::CodeModels() {
  for (std::uint32_t i = 0; i < 2 * kPlaced; ++i) {
    const std::uint32_t scale = i % kScales;
    model[i] = RiceModel(scale == 0 ? 0 : 1u << (scale - 1));
  }
}

AttributeCoder::AttributeCoder(const AttributeFormat& format) : format_(format) {
  const std::array<std::uint32_t, kFieldCount> width{
      3, format.normals ? (format.normal_bits > 0 ? 2u : 3u) : 0u, format.texcoords ? 2u : 0u,
      format.colors ? 4u : 0u};
  for (std::size_t i = 0; i < kFieldCount; ++i)
    first_channel_[i + 1] = first_channel_[i] + width[i];
  channel_count_ = first_channel_[kFieldCount];
  if (format.position_bits > 0) kind_[0] = Kind::kWhole;
  if (format.normal_bits > 0) kind_[1] = Kind::kOctahedral;
  if (format.texcoord_bits > 0) kind_[2] = Kind::kWhole;
}

Codes AttributeCoder::encode(const TriangleMesh& attributes, std::uint32_t vertex) const {
  Codes codes{};
  std::uint32_t* to = codes.data();
  const Vec3& position = attributes.positions[vertex];
  for (int axis = 0; axis < 3; ++axis)
    *to++ = format_.position_bits == 0 ? ordered(position[axis])
                                       : to_grid(static_cast<double>(position[axis]),
                                                 static_cast<double>(format_.position_origin[axis]),
                                                 format_.position_step, format_.position_bits);
  if (format_.normals) {
    const Vec3& normal = attributes.normals[vertex];
    if (format_.normal_bits > 0) {
      const DVec3 n(normal);
      for (const std::uint32_t code : Octahedron(format_.normal_bits).codes(n.x, n.y, n.z))
        *to++ = code;
    } else {
      for (int axis = 0; axis < 3; ++axis) *to++ = ordered(normal[axis]);
    }
  }
  if (format_.texcoords) {
    const Vec2& texcoord = attributes.texcoords[vertex];
    for (int axis = 0; axis < 2; ++axis)
      *to++ = format_.texcoord_bits == 0
                  ? ordered(texcoord[axis])
                  : to_grid(static_cast<double>(texcoord[axis]),
                            static_cast<double>(format_.texcoord_origin[axis]),
                            format_.texcoord_step[static_cast<std::size_t>(axis)],
                            format_.texcoord_bits);
  }
  if (format_.colors)
    for (int i = 0; i < 4; ++i) *to++ = attributes.colors[vertex][i];
  return codes;
}

bool AttributeCoder::decode(const Codes& codes, TriangleMesh& attributes,
                            std::uint32_t vertex) const {
  bool good = decode_position(format_, codes.data(), attributes.positions[vertex]);
  if (format_.normals)
    good &= decode_normal(format_, codes.data() + first_channel(Field::kNormal),
                          attributes.normals[vertex]);
  if (format_.texcoords)
    good &= decode_texcoord(format_, codes.data() + first_channel(Field::kTexcoord),
                            attributes.texcoords[vertex]);
  if (format_.colors) {
    const std::uint32_t* from = codes.data() + first_channel(Field::kColor);
    for (int i = 0; i < 4; ++i) {
      good &= from[i] <= 255;
      attributes.colors[vertex][i] = static_cast<std::uint8_t>(from[i]);
    }
  }
  return good;
}

void AttributeCoder::resize(TriangleMesh& attributes, std::size_t count) const {
  if (attributes.positions.size() == count) return;
  attributes.positions.resize(count);
  if (format_.normals) attributes.normals.resize(count);
  if (format_.texcoords) attributes.texcoords.resize(count);
  if (format_.colors) attributes.colors.resize(count);
}

// Positions on a grid share one model, by the longest axis: the scale is that of the ring. Floats
// near zero have a scale of their own.
void AttributeCoder::choose_models(Field field, const std::uint32_t* near,
                                   std::uint32_t first_model, Prediction& prediction) const {
  const std::uint32_t first = first_channel(field), end = end_channel(field);
  std::uint32_t longest = 0;
  for (std::uint32_t c = first; c < end; ++c)
    longest = std::max(longest, distance(prediction.codes[c], near[c]));
  const bool common = kind_[static_cast<std::size_t>(field)] != Kind::kFloat;
  for (std::uint32_t c = first; c < end; ++c) {
    const std::uint32_t scale = common ? longest : distance(prediction.codes[c], near[c]);
    prediction.model[c] = static_cast<std::uint16_t>(first_model + model_of(field, scale));
  }
}

void AttributeCoder::mean_of_floats(Field field, std::span<const std::uint32_t> ring,
                                    const std::vector<std::uint32_t>& table, Codes& codes) const {
  const std::uint32_t first = first_channel(field), end = end_channel(field);
  std::array<double, 3> sum{0, 0, 0};
  for (const std::uint32_t v : ring) {
    const std::uint32_t* from = table.data() + std::size_t{v} * channel_count_ + first;
    for (std::uint32_t i = 0; i < end - first; ++i)
      sum[i] += static_cast<double>(unordered(from[i]));
  }
  const double share = 1 / static_cast<double>(ring.size());
  for (std::uint32_t i = 0; i < end - first; ++i)
    codes[first + i] = ordered_or_zero(sum[i] * share);
}

void AttributeCoder::mean_of_normals(std::span<const std::uint32_t> ring,
                                     const std::vector<std::uint32_t>& table, Codes& codes) const {
  const std::uint32_t first = first_channel(Field::kNormal);
  const Octahedron octahedron(format_.normal_bits);
  std::array<std::int64_t, 3> sum{0, 0, 0};
  for (const std::uint32_t v : ring) {
    const std::uint32_t* from = table.data() + std::size_t{v} * channel_count_ + first;
    const std::array<int, 3> point = octahedron.point(from[0], from[1]);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += point[i];
  }
  const auto mean = octahedron.codes(sum[0], sum[1], sum[2]);
  codes[first] = mean[0];
  codes[first + 1] = mean[1];
}

namespace {

template <std::size_t kWidth>
void mean_of_codes(std::span<const std::uint32_t> ring, const std::uint32_t* table,
                   std::size_t stride, std::uint32_t* mean) {
  const std::uint64_t half = ring.size() / 2;
  std::array<std::uint64_t, kWidth> sum;
  sum.fill(half);
  for (const std::uint32_t v : ring)
    for (std::size_t i = 0; i < kWidth; ++i) sum[i] += table[v * stride + i];
  for (std::size_t i = 0; i < kWidth; ++i)
    mean[i] = static_cast<std::uint32_t>(sum[i] / ring.size());
}

}  // namespace

void AttributeCoder::predict_mean(Field field, std::span<const std::uint32_t> ring,
                                  std::uint32_t near, const std::vector<std::uint32_t>& table,
                                  Prediction& prediction) const {
  const std::uint32_t first = first_channel(field), end = end_channel(field);
  if (first == end) return;
  if (ring.empty()) ring = {&near, 1};
  switch (kind_[static_cast<std::size_t>(field)]) {
    case Kind::kFloat:
      mean_of_floats(field, ring, table, prediction.codes);
      break;
    case Kind::kOctahedral:
      mean_of_normals(ring, table, prediction.codes);
      break;
    case Kind::kWhole:
      if (end - first == 3)
        mean_of_codes<3>(ring, table.data() + first, channel_count_,
                         prediction.codes.data() + first);
      else if (end - first == 2)
        mean_of_codes<2>(ring, table.data() + first, channel_count_,
                         prediction.codes.data() + first);
      else
        mean_of_codes<4>(ring, table.data() + first, channel_count_,
                         prediction.codes.data() + first);
  }
  choose_models(field, table.data() + std::size_t{near} * channel_count_, 0, prediction);
}

Prediction AttributeCoder::predict_placed(const Codes& old_codes, const Codes& split_off) const {
  Prediction prediction;
  prediction.codes = old_codes;
  for (std::uint32_t c = 0; c < 3; ++c) {
    if (format_.position_bits == 0) {
      prediction.codes[c] = ordered_or_zero(2 * static_cast<double>(unordered(old_codes[c])) -
                                            static_cast<double>(unordered(split_off[c])));
    } else {
      const std::int64_t opposite = 2 * std::int64_t{old_codes[c]} - std::int64_t{split_off[c]};
      const std::int64_t last = (std::int64_t{1} << format_.position_bits) - 1;
      prediction.codes[c] = static_cast<std::uint32_t>(std::clamp<std::int64_t>(opposite, 0, last));
    }
  }
  for (std::uint32_t i = 0; i < kFieldCount; ++i)
    choose_models(static_cast<Field>(i), split_off.data(), CodeModels::kPlaced, prediction);
  return prediction;
}

Prediction AttributeCoder::predict_next(const Codes& previous) const {
  Prediction prediction;
  prediction.codes = previous;
  for (std::uint32_t i = 0; i < kFieldCount; ++i) {
    const auto field = static_cast<Field>(i);
    for (std::uint32_t c = first_channel(field); c < end_channel(field); ++c)
      prediction.model[c] = model_of(field, 0);
  }
  return prediction;
}

namespace {

template <class V>
void add_to_range(const std::vector<V>& values, int axis, double& lower, double& upper) {
  for (const V& value : values) {
    if (!std::isfinite(value[axis])) continue;
    lower = std::min(lower, static_cast<double>(value[axis]));
    upper = std::max(upper, static_cast<double>(value[axis]));
  }
}

// The least and the greatest value of an axis; 0 and 0 where there is none.
template <class V>
std::array<double, 2> axis_range(const std::vector<V>& a, const std::vector<V>& b, int axis) {
  double lower = HUGE_VAL, upper = -HUGE_VAL;
  add_to_range(a, axis, lower, upper);
  add_to_range(b, axis, lower, upper);
  return lower <= upper ? std::array{lower, upper} : std::array{0.0, 0.0};
}

}  // namespace

double fit_grids(const TriangleMesh& mesh, const TriangleMesh& placed, AttributeFormat& format) {
  for (int axis = 0; axis < 2 && format.texcoord_bits > 0; ++axis) {
    const auto [lower, upper] = axis_range(mesh.texcoords, placed.texcoords, axis);
    format.texcoord_origin[axis] = static_cast<float>(lower);
    format.texcoord_step[static_cast<std::size_t>(axis)] =
        (upper - lower) / static_cast<double>((1u << format.texcoord_bits) - 1);
  }
  if (format.position_bits == 0) return 0;

  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [lower, upper] = axis_range(mesh.positions, placed.positions, axis);
    format.position_origin[axis] = static_cast<float>(lower);
    longest = std::max(longest, upper - lower);
  }
  format.position_step = longest / static_cast<double>((1u << format.position_bits) - 1);

  double farthest = 0;
  for (const auto* positions : {&mesh.positions, &placed.positions})
    for (const Vec3& position : *positions) {
      DVec3 moved;
      for (int axis = 0; axis < 3; ++axis) {
        const auto origin = static_cast<double>(format.position_origin[axis]);
        const std::uint32_t code = to_grid(static_cast<double>(position[axis]), origin,
                                           format.position_step, format.position_bits);
        moved[axis] = static_cast<double>(from_grid(code, origin, format.position_step)) -
                      static_cast<double>(position[axis]);
      }
      farthest = std::max(farthest, glm::dot(moved, moved));
    }
  return std::sqrt(farthest);
}

}  // namespace varifold::pm
