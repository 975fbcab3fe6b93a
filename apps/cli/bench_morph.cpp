#include <apps/cli/bench_morph.h>
#include <fmt/format.h>

namespace varifold::cli {

std::vector<float> weights_on_way(std::size_t poses, double part) {
  const double place = part * static_cast<double>(poses);
  const std::size_t pose = std::min(static_cast<std::size_t>(place), poses - 1);
  const double beyond = place - static_cast<double>(pose);
  // Pose number i has weight i - 1 of these; the shape at rest has none.
  std::vector<float> weights(pose + 1, 0.0f);
  weights[pose] = static_cast<float>(beyond);
  if (pose > 0) weights[pose - 1] = static_cast<float>(1 - beyond);
  return weights;
}

std::string morph_row(const Json& result) {
  double greatest = 0;
  for (const Json& level : result["constant_levels"])
    greatest = std::max(greatest, level["greatest_share_of_frame"].get<double>());
  const Json& changing = result["level_every_24_frames"];
  std::string text =
      fmt::format("{}: at most {:.3f} % of a frame at constant levels, {:.3f} % with changes",
                  result["kind"].get<std::string>(), 100 * greatest,
                  100 * changing["greatest_share_of_frame"].get<double>());
  if (!changing["frames_per_second"].is_null())
    text += fmt::format(", {:.0f} frames/s", changing["frames_per_second"].get<double>());
  return text;
}

}  // namespace varifold::cli
