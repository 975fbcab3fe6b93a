#include <apps/cli/context.h>
#include <apps/cli/stripifier.h>
#include <varifold/strip/sequence_strips.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <vector>

namespace varifold::cli {
namespace {

struct NamedHeuristic {
  const char* name;
  StripHeuristic heuristic;
};
constexpr std::array<NamedHeuristic, 7> kHeuristics{{{"first", StripHeuristic::kFirst},
                                                     {"random", StripHeuristic::kRandom},
                                                     {"look-ahead", StripHeuristic::kLookAhead},
                                                     {"alternate", StripHeuristic::kAlternate},
                                                     {"sequential", StripHeuristic::kSequential},
                                                     {"straight", StripHeuristic::kStraight},
                                                     {"rows", StripHeuristic::kRows}}};

StripHeuristic heuristic_of(const std::string& name) {
  const auto* const found =
      std::find_if(kHeuristics.begin(), kHeuristics.end(),
                   [&](const NamedHeuristic& known) { return known.name == name; });
  assert(found != kHeuristics.end());
  return found->heuristic;
}

void add_length_options(CLI::App& command, StripifierOptions& options) {
  std::vector<std::string> names;
  names.reserve(kHeuristics.size());
  for (const NamedHeuristic& known : kHeuristics) names.emplace_back(known.name);
  command
      .add_option("--heuristic", options.heuristic,
                  "Of --stripifier length. Local, the fewest free neighbours first and between "
                  "equals: first; random; look-ahead: whose neighbours have the fewest; alternate: "
                  "left and right in turn; sequential: without a swap. straight: without a swap "
                  "before all else. rows: global, the longest rows first")
      ->check(CLI::IsMember(names))
      ->capture_default_str()
      ->type_name("RULE");
  command.add_flag("--keep-ends", options.keep_ends,
                   "Of --stripifier length: do not join strips whose ends meet");
  command.add_option("--strip-seed", options.seed, "Of --heuristic random")
      ->capture_default_str()
      ->type_name("S");
}

}  // namespace

void add_stripifier_options(CLI::App& command, StripifierOptions& options) {
  command
      .add_option("--stripifier", options.name,
                  "length: few indices; cache: few misses of a vertex cache; sequence: along the "
                  "collapses, from coarse to fine")
      ->check(CLI::IsMember({"length", "cache", "sequence"}))
      ->capture_default_str()
      ->type_name("KIND");
  command
      .add_option("--cache-size", options.cache_size,
                  "Entries that --stripifier cache is for (default 16)")
      ->check(CLI::IsMember({16u, 24u}))
      ->type_name("N");
  add_length_options(command, options);
  command
      .add_option("--max-indices", options.max_indices,
                  "No strip is longer, since long ones are slow to change; 0: no limit (default " +
                      std::to_string(options.usual_max_indices) + "); not with sequence")
      ->check([](const std::string& text) {
        const bool small = text == "1" || text == "2" || text == "3";
        return small ? std::string("a strip needs at least 4") : std::string();
      })
      ->type_name("N");
}

void check_stripifier_options(const StripifierOptions& options) {
  const StripifierOptions usual;
  if (options.name != "length") {
    if (options.heuristic != usual.heuristic)
      wrong_usage("--heuristic is for --stripifier length, not " + options.name);
    if (options.keep_ends)
      wrong_usage("--keep-ends is for --stripifier length, not " + options.name);
  }
  if (options.heuristic != "random" && options.seed != usual.seed)
    wrong_usage("--strip-seed is for --heuristic random");
  if (options.max_indices && options.name == "sequence")
    wrong_usage("--max-indices is for --stripifier length and cache, not sequence");
  if (options.cache_size && options.name != "cache")
    wrong_usage("--cache-size is for --stripifier cache, not " + options.name);
}

TriangleStrips make_strips(const DetailedMesh& detailed, const StripifierOptions& options) {
  if (options.name == "sequence") return stripify_along_sequence(detailed);
  StripifyOptions stripify_options;
  stripify_options.heuristic = heuristic_of(options.heuristic);
  stripify_options.join_ends = !options.keep_ends;
  stripify_options.seed = options.seed;
  stripify_options.cache_size = options.cache_size.value_or(16);
  const std::uint32_t most = options.max_indices.value_or(options.usual_max_indices);
  stripify_options.max_indices = most == 0 ? 0 : std::max(4u, most);
  if (options.name == "cache") stripify_options.method = StripMethod::kCacheAware;
  return stripify(detailed.mesh, stripify_options);
}

}  // namespace varifold::cli
