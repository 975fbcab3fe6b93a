#include <apps/cli/contact_sheet.h>

namespace varifold::cli {

void paste(const Image8& from, int x, int y, Image8& to) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(from.width);
  for (int row = 0; row < from.height; ++row) {
    const std::size_t source = static_cast<std::size_t>(row) * row_bytes;
    const std::size_t target =
        3 * (static_cast<std::size_t>(y + row) * static_cast<std::size_t>(to.width) +
             static_cast<std::size_t>(x));
    std::copy_n(from.rgb.begin() + static_cast<std::ptrdiff_t>(source), row_bytes,
                to.rgb.begin() + static_cast<std::ptrdiff_t>(target));
  }
}

}  // namespace varifold::cli
