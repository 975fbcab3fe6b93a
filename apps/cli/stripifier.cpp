#include <apps/cli/stripifier.h>
#include <varifold/strip/sequence_strips.h>
#include <varifold/strip/stripify.h>
#include <algorithm>

namespace varifold::cli {

void add_stripifier_options(CLI::App& command, StripifierOptions& options) {
  command
      .add_option("--stripifier", options.name,
                  "length: few indices; cache: few misses of a vertex cache; sequence: along the "
                  "collapses, from coarse to fine")
      ->check(CLI::IsMember({"length", "cache", "sequence"}))
      ->capture_default_str()
      ->type_name("KIND");
  command.add_option("--cache-size", options.cache_size, "Entries that --stripifier cache is for")
      ->check(CLI::IsMember({16u, 24u}))
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option("--max-indices", options.max_indices,
                  "No strip is longer, since long ones are slow to change; 0: no limit")
      ->check([](const std::string& text) {
        const bool small = text == "1" || text == "2" || text == "3";
        return small ? std::string("a strip needs at least 4") : std::string();
      })
      ->capture_default_str()
      ->type_name("N");
}

TriangleStrips make_strips(const DetailedMesh& detailed, const StripifierOptions& options) {
  if (options.name == "sequence") return stripify_along_sequence(detailed);
  StripifyOptions stripify_options;
  stripify_options.cache_size = options.cache_size;
  stripify_options.max_indices = options.max_indices == 0 ? 0 : std::max(4u, options.max_indices);
  if (options.name == "cache") stripify_options.method = StripMethod::kCacheAware;
  return stripify(detailed.mesh, stripify_options);
}

}  // namespace varifold::cli
