#include <apps/cli/simplify_options.h>
#include <fmt/format.h>

namespace varifold::cli {

void add_simplify_flags(CLI::App& command, SimplifyFlags& flags) {
  command
      .add_option("--placement", flags.placement,
                  "kept: vertices of the input only; optimal: where the error is least")
      ->check(CLI::IsMember({"kept", "optimal"}))
      ->capture_default_str()
      ->type_name("KIND");
  command
      .add_option("--metric", flags.metric,
                  "quadric: distance to planes, fast; energy: distance of samples of the original "
                  "[Hoppe1996], slower")
      ->check(CLI::IsMember({"quadric", "energy"}))
      ->capture_default_str()
      ->type_name("KIND");
  command
      .add_option(
          "--energy-samples", flags.energy_samples,
          "With --metric energy: samples for each triangle, beside the vertices (default: 1)")
      ->check(CLI::Range(0.0f, 1000.0f))
      ->type_name("S");
  add_weight_options(command, flags.weights);
}

void add_weight_options(CLI::App& command, AttributeWeights& weights) {
  const auto add_weight = [&](const char* name, float& weight, const char* help) {
    command.add_option(name, weight, help)
        ->check(CLI::NonNegativeNumber)
        ->check(finite_number())
        ->capture_default_str()
        ->type_name("W");
  };
  add_weight("--normal-weight", weights.normal,
             "What normals count beside distances, as a part of the diagonal; 0: nothing");
  add_weight("--texcoord-weight", weights.texcoord, "The same for texture coordinates");
  add_weight("--color-weight", weights.color, "The same for colours");
}

SimplifyOptions simplify_options(const SimplifyFlags& flags, const CommonOptions& common,
                                 const std::filesystem::path& input) {
  SimplifyOptions options;
  options.placement = flags.placement == "optimal" ? Placement::kOptimal : Placement::kKept;
  options.metric = flags.metric == "energy" ? Metric::kEnergy : Metric::kQuadric;
  if (flags.energy_samples) {
    if (options.metric != Metric::kEnergy)
      wrong_usage("--energy-samples is for --metric energy: quadrics need no samples");
    options.energy.samples_per_triangle = *flags.energy_samples;
  }
  options.attributes = flags.weights;
  options.threads = common.threads;
  options.progress = show_progress(input.filename().string());
  return options;
}

Result<void> check_any_left(const Simplification& result, const std::filesystem::path& input) {
  if (!result.detailed.mesh.indices.empty()) return {};
  return fail(ErrorKind::kInvalidInput,
              fmt::format("{}: all {} triangles are degenerate: two corners at one position",
                          input.string(), format_count(result.faults.degenerate_triangles)));
}

namespace {

// Those of the counts that are not zero, by name.
template <std::size_t kCount>
Json named_counts(const std::array<std::uint32_t, kCount>& counts, const char* const* names) {
  Json object = Json::object();
  for (std::size_t i = 0; i < kCount; ++i)
    if (counts[i] > 0) object[names[i]] = counts[i];
  return object;
}

std::string listed(const Json& counts) {
  std::string text;
  for (const auto& [name, count] : counts.items())
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", format_count(count), name);
  return text;
}

}  // namespace

void report_stop(const StopReport& stop, const std::filesystem::path& input, Report& report) {
  report.text("stop_reason", "stopped because", stop_reason_name(stop.reason));
  if (stop.reason != StopReason::kStuck) return;
  const Json left = named_counts(stop.left_by_kind, kVertexKindNames);
  const Json refusals = named_counts(stop.refusals, kRefusalNames);
  report.set("left_by_kind", left);
  report.set("refusals", refusals);
  report.set("advice", stop.advice);
  print_message(fmt::format("{}: stuck at {} triangles: no legal collapse is left", input.string(),
                            format_count(stop.triangles)));
  print_message(fmt::format("{}: vertices left: {}; refused because of: {}", input.string(),
                            listed(left), listed(refusals)));
  if (!stop.advice.empty()) print_message(fmt::format("{}: {}", input.string(), stop.advice));
}

}  // namespace varifold::cli
