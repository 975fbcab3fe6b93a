#include <varifold/io/ply_columns.h>

#include <varifold/base/bytes.h>
#include <algorithm>
#include <optional>
#include <string_view>

namespace varifold::ply {
namespace {

/// Calls action with a zero of the C++ type that `type` names.
template <class Action>
auto with_type(Type type, Action action) {
  switch (type) {
    case Type::kInt8:
      return action(std::int8_t{});
    case Type::kUint8:
      return action(std::uint8_t{});
    case Type::kInt16:
      return action(std::int16_t{});
    case Type::kUint16:
      return action(std::uint16_t{});
    case Type::kInt32:
      return action(std::int32_t{});
    case Type::kUint32:
      return action(std::uint32_t{});
    case Type::kFloat32:
      return action(float{});
    case Type::kFloat64:
      break;
  }
  return action(double{});
}

template <class T>
T load_as(Encoding encoding, const std::byte* from) {
  return encoding == Encoding::kBinaryBig ? load<T, std::endian::big>(from) : load<T>(from);
}

/// The properties of these names, all scalars, or nothing.
template <std::size_t kCount>
std::optional<std::array<std::uint32_t, kCount>> find_all(
    const Element& element, const std::array<std::string_view, kCount>& names) {
  std::array<std::uint32_t, kCount> found{};
  for (std::size_t i = 0; i < kCount; ++i) {
    found[i] = element.find(names[i]);
    if (found[i] == kNone || element.properties[found[i]].is_list) return std::nullopt;
  }
  return found;
}

/// Appends one float column per property, side by side in `values`.
template <class T, std::size_t kCount>
void bind_floats(const std::array<std::uint32_t, kCount>& properties, std::size_t rows,
                 std::vector<T>& values, std::vector<Column>& columns) {
  static_assert(sizeof(T) == kCount * sizeof(float));
  values.resize(rows);
  if (rows == 0) return;
  float* const first = &values[0][0];
  for (std::size_t i = 0; i < kCount; ++i) {
    Column column;
    column.property = properties[i];
    column.floats = first + i;
    column.stride = kCount;
    columns.push_back(column);
  }
}

float color_scale(Type type) {
  if (is_float(type)) return 1;
  return type == Type::kUint16 ? 1 / 65535.0f : 1 / 255.0f;
}

void bind_colors(const Element& element, TriangleMesh& mesh, std::size_t& not_finite,
                 std::vector<Column>& columns) {
  const auto rgb = find_all<3>(element, {"red", "green", "blue"});
  if (!rgb) return;
  mesh.colors.assign(element.count, Color(0, 0, 0, 255));
  if (element.count == 0) return;
  std::vector<std::uint32_t> properties(rgb->begin(), rgb->end());
  if (const auto alpha = find_all<1>(element, {"alpha"})) properties.push_back(alpha->front());
  std::uint8_t* const first = &mesh.colors[0][0];
  for (std::size_t i = 0; i < properties.size(); ++i) {
    Column column;
    column.property = properties[i];
    column.bytes = first + i;
    column.not_finite = &not_finite;
    column.stride = sizeof(Color);
    column.scale = color_scale(element.properties[properties[i]].type);
    columns.push_back(column);
  }
}

}  // namespace

Result<std::vector<Column>> bind_columns(const Element& element, TriangleMesh& mesh,
                                         std::size_t& not_finite) {
  std::vector<Column> columns;
  const auto position = find_all<3>(element, {"x", "y", "z"});
  if (!position)
    return fail(ErrorKind::kInvalidInput, "element 'vertex' has no properties x, y and z");
  bind_floats(*position, element.count, mesh.positions, columns);
  if (const auto normal = find_all<3>(element, {"nx", "ny", "nz"}))
    bind_floats(*normal, element.count, mesh.normals, columns);
  constexpr std::array<std::array<std::string_view, 2>, 3> kTexcoordNames{
      {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
  for (const auto& names : kTexcoordNames) {
    const auto texcoord = find_all<2>(element, names);
    if (!texcoord) continue;
    bind_floats(*texcoord, element.count, mesh.texcoords, columns);
    break;
  }
  bind_colors(element, mesh, not_finite, columns);
  std::sort(columns.begin(), columns.end(),
            [](const Column& a, const Column& b) { return a.property < b.property; });
  return columns;
}

void decode_column(const Column& column, Type type, Encoding encoding, const RowBlock& block) {
  const auto decode = [&]<std::endian kOrder, class T>(T) {
    // A copy, so that the compiler need not reload it after every byte that is stored.
    const Column target = column;
    const std::byte* from = block.first;
    for (std::size_t i = 0; i < block.rows; ++i, from += block.row_bytes)
      target.store(block.first_row + i, static_cast<float>(load<T, kOrder>(from)));
  };
  with_type(type, [&]<class T>(T zero) {
    if (encoding == Encoding::kBinaryBig)
      decode.template operator()<std::endian::big>(zero);
    else
      decode.template operator()<std::endian::little>(zero);
  });
}

float load_float(Type type, Encoding encoding, const std::byte* from) {
  return with_type(type,
                   [&]<class T>(T) { return static_cast<float>(load_as<T>(encoding, from)); });
}

std::int64_t load_integer(Type type, Encoding encoding, const std::byte* from) {
  return with_type(type, [&]<class T>(T) -> std::int64_t {
    if constexpr (std::is_floating_point_v<T>)
      return 0;
    else
      return static_cast<std::int64_t>(load_as<T>(encoding, from));
  });
}

}  // namespace varifold::ply
