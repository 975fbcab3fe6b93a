// varifold build strips|lodstrips|mts: a mesh becomes a model of triangle strips.
#include <apps/cli/build_common.h>
#include <apps/cli/index_report.h>
#include <apps/cli/stripifier.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/strips/build.h>
#include <memory>

namespace varifold::cli {
namespace {

// One specialisation for each kind: what its subcommand says, the options that it alone has, and
// how it is built.
template <class Model>
struct StripsBuild;

template <>
struct StripsBuild<MultiresolutionStrips> {
  static constexpr const char* kHelp = "Multiresolution triangle strips (MTS), a baseline";
  struct Options {
    StripifierOptions stripifier;
  };
  static void add_options(CLI::App& command, Options& options) {
    add_stripifier_options(command, options.stripifier);
  }
  static MultiresolutionStrips build(const DetailedMesh& detailed, const Options& options) {
    return build_mts(detailed, make_strips(detailed, options.stripifier));
  }
};

template <>
struct StripsBuild<StripFramework> {
  static constexpr const char* kHelp = "The strips framework: static strips, levels per region too";
  struct Options {
    StripifierOptions stripifier;
  };
  static void add_options(CLI::App& command, Options& options) {
    add_stripifier_options(command, options.stripifier);
  }
  static StripFramework build(const DetailedMesh& detailed, const Options& options) {
    return build_strip_framework(detailed, make_strips(detailed, options.stripifier));
  }
};

template <>
struct StripsBuild<LodStrips> {
  static constexpr const char* kHelp = "LodStrips: strips changed in place, ready to be drawn";
  struct Options {
    std::string form = "blocks";
    StripifierOptions stripifier;
  };
  static void add_options(CLI::App& command, Options& options) {
    command
        .add_option("--form", options.form,
                    "blocks: strips built from coarse to fine, in blocks; grouped, thesis: strips "
                    "of the full mesh, with the records of chapters 5 and 4 of the thesis")
        ->check(CLI::IsMember({"blocks", "grouped", "thesis"}))
        ->capture_default_str()
        ->type_name("FORM");
    options.stripifier.usual_max_indices = kStaticStripIndices;
    add_stripifier_options(command, options.stripifier);
  }
  static void check_options(const Options& options) {
    const StripifierOptions usual{.usual_max_indices = kStaticStripIndices};
    if (options.form == "blocks" && options.stripifier != usual)
      wrong_usage("--form blocks makes its own strips: a stripifier is for grouped and thesis");
  }
  static LodStrips build(const DetailedMesh& detailed, const Options& options) {
    if (options.form == "blocks") return build_lod_strips(detailed);
    const auto form = options.form == "grouped" ? LodStripsForm::kGrouped : LodStripsForm::kThesis;
    return build_lod_strips(detailed, form, make_strips(detailed, options.stripifier));
  }
};

// What is drawn at full detail.
template <class Model>
void report_strips(const std::shared_ptr<const Model>& model, Report& report) {
  InstanceOf<Model> instance(model);
  instance.go_to_level(model->finest_level());
  report_indices(index_measures(instance.draw_list()), report);
}

template <class Model>
struct StripsCommand {
  BuildOptions build;
  typename StripsBuild<Model>::Options own;
};

template <class Model>
CommandResult run_build(const StripsCommand<Model>& command) {
  if constexpr (requires { StripsBuild<Model>::check_options(command.own); })
    StripsBuild<Model>::check_options(command.own);
  check_stripifier_options(command.own.stripifier);
  if (command.build.flags.placement == "optimal")
    wrong_usage("--placement optimal: strips name vertices, they do not move them; use kept");
  const auto make = [&command](const DetailedMesh& detailed) {
    return std::make_shared<const Model>(StripsBuild<Model>::build(detailed, command.own));
  };
  const auto tell = [](const std::shared_ptr<const Model>& model, Report& report) {
    if constexpr (requires { model->form_kind(); })
      report.text("form", "form", std::string(form_name(model->form_kind())));
    report_strips(model, report);
  };
  return build_and_write(command.build, make, tell);
}

template <class Model>
void add_kind(CLI::App& build, CommandRunner& runner) {
  CLI::App* const command =
      build.add_subcommand(ModelKind<Model>::kName, StripsBuild<Model>::kHelp);
  const auto options = std::make_shared<StripsCommand<Model>>();
  add_build_options(*command, options->build);
  StripsBuild<Model>::add_options(*command, options->own);
  runner.add_common(*command, options->build.common, true);
  runner.attach(*command, options->build.common, [options] { return run_build<Model>(*options); });
}

}  // namespace

void add_build_strips(CLI::App& build, CommandRunner& runner) {
  add_kind<StripFramework>(build, runner);
  add_kind<LodStrips>(build, runner);
  add_kind<MultiresolutionStrips>(build, runner);
}

}  // namespace varifold::cli
