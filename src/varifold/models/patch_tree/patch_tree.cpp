#include <varifold/models/patch_tree/patch_tree.h>

#include <varifold/models/common/extract_level.h>

namespace varifold {

namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

}  // namespace

std::size_t PatchTree::bytes() const {
  const PatchTopology& t = data_.topology;
  return bytes_of(t.first_of_level) + bytes_of(t.parent) + bytes_of(t.first_child) +
         bytes_of(t.first_neighbor) + bytes_of(t.neighbors) + bytes_of(data_.bounds) +
         bytes_of(data_.offsets) + attribute_bytes(data_.vertices) + bytes_of(data_.survivors) +
         bytes_of(data_.controllers) + bytes_of(data_.corners) + bytes_of(data_.ranges);
}

}  // namespace varifold
