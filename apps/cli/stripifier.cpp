#include <apps/cli/context.h>
#include <apps/cli/stripifier.h>
#include <varifold/strip/sequence_strips.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <string>

namespace varifold::cli {

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
  if (options.max_indices && options.name == "sequence")
    wrong_usage("--max-indices is for --stripifier length and cache, not sequence");
  if (options.cache_size && options.name != "cache")
    wrong_usage("--cache-size is for --stripifier cache, not " + options.name);
}

TriangleStrips make_strips(const DetailedMesh& detailed, const StripifierOptions& options) {
  if (options.name == "sequence") return stripify_along_sequence(detailed);
  StripifyOptions stripify_options;
  stripify_options.cache_size = options.cache_size.value_or(16);
  const std::uint32_t most = options.max_indices.value_or(options.usual_max_indices);
  stripify_options.max_indices = most == 0 ? 0 : std::max(4u, most);
  if (options.name == "cache") stripify_options.method = StripMethod::kCacheAware;
  return stripify(detailed.mesh, stripify_options);
}

}  // namespace varifold::cli
