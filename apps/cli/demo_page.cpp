#include <apps/cli/demo_page.h>
#include <fmt/format.h>
#include <varifold/io/mapped_file.h>
#include <array>
#include <cstddef>
#include <span>

namespace varifold::cli {
namespace {

constexpr const char* kStyle = R"(
:root { --ink: #1d2733; --soft: #5c6b7a; --line: #d9e0e7; --paper: #fbfcfd; --accent: #b4562b; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 0 24px 64px; }
header { padding: 56px 0 20px; }
h1 { font-size: 40px; line-height: 1.1; margin: 0 0 12px; letter-spacing: -0.02em; }
h2 { font-size: 26px; margin: 56px 0 6px; letter-spacing: -0.01em; }
p { margin: 0 0 14px; max-width: 72ch; color: var(--soft); }
header p { font-size: 19px; }
figure { margin: 0; background: #fff; border: 1px solid var(--line); border-radius: 10px;
  overflow: hidden; }
figure img { display: block; width: 100%; height: auto; }
figcaption { padding: 9px 14px; font-size: 14px; color: var(--soft); border-top: 1px solid var(--line);
  font-variant-numeric: tabular-nums; }
figcaption b { color: var(--ink); }
.row { display: grid; gap: 16px; grid-template-columns: repeat(auto-fit, minmax(230px, 1fr));
  margin: 18px 0; }
.stage { display: grid; grid-template-columns: 1fr 1fr; gap: 16px; margin: 18px 0 8px; }
.control { display: flex; gap: 16px; align-items: center; margin: 14px 0 4px; }
.control input { flex: 1; accent-color: var(--accent); }
.control output { min-width: 21em; text-align: right; font-variant-numeric: tabular-nums; }
.hidden { display: none; }
table { border-collapse: collapse; width: 100%; margin: 16px 0; font-size: 15px;
  font-variant-numeric: tabular-nums; background: #fff; border: 1px solid var(--line); }
th, td { padding: 8px 12px; text-align: right; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); font-size: 13px; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; }
code, pre { font: 14px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
pre { background: #eef2f5; border-radius: 8px; padding: 14px 16px; overflow-x: auto; }
.good { color: #2c7a4b; } .bad { color: #b3261e; font-weight: 600; }
footer { margin-top: 56px; color: var(--soft); font-size: 14px; }
@media (max-width: 720px) { .stage { grid-template-columns: 1fr; } h1 { font-size: 30px; } }
)";

constexpr const char* kScript = R"(
const slider = document.getElementById("level"), told = document.getElementById("told");
const show = () => {
  document.querySelectorAll("[data-level]").forEach(figure =>
    figure.classList.toggle("hidden", figure.dataset.level !== slider.value));
  told.textContent = document.querySelector(`[data-level="${slider.value}"]`).dataset.told;
};
if (slider) { slider.addEventListener("input", show); show(); }
)";

std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8 | (j < count ? std::to_integer<std::uint32_t>(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += j <= count ? kDigits[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

class PageWriter {
 public:
  PageWriter(const DemoResult& result, const std::filesystem::path& folder)
      : result_(result), folder_(folder) {}

  Result<std::string> write() {
    add("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>Varifold: the demo</title>\n<style>");
    add(kStyle);
    add("</style>\n</head>\n<body>\n<main>\n");
    add_head();
    add_main_model();
    add_crowd();
    add_stream();
    add_others();
    add_strips();
    add_builds();
    add("<footer>Made by <code>varifold demo</code>");
    if (!result_.device.empty()) add(fmt::format("; drawn by {}", escaped(result_.device)));
    add(".</footer>\n</main>\n<script>");
    add(kScript);
    add("</script>\n</body>\n</html>\n");
    if (!fault_.message.empty()) return tl::unexpected(fault_);
    return std::move(text_);
  }

 private:
  void add(std::string_view text) { text_ += text; }

  static std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
      if (c == '&')
        result += "&amp;";
      else if (c == '<')
        result += "&lt;";
      else
        result += c;
    }
    return result;
  }

  void add_picture(const std::string& name, const std::string& description) {
    const auto file = MappedFile::open(folder_ / name);
    if (!file) {
      fault_ = file.error();
      return;
    }
    add(fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,", escaped(description)));
    add(base64(file->bytes()));
    add("\">");
  }

  void add_figure(const std::string& name, const std::string& description,
                  const std::string& caption) {
    if (name.empty()) return;
    add("<figure>");
    add_picture(name, description);
    add("<figcaption>" + caption + "</figcaption></figure>\n");
  }

  // A distance as a part of the diagonal.
  static std::string part_of(double distance, const DemoModel& model) {
    return distance == 0 ? "0" : fmt::format("{:.2g}", distance / model.diagonal);
  }
  static std::string caption(const DemoLevel& level, const DemoModel& model) {
    const std::string triangles = fmt::format("<b>{}</b> triangles", format_count(level.triangles));
    if (level.error == 0) return triangles + " · full detail";
    return triangles + " · error " + part_of(level.error, model) + " of the diagonal";
  }

  void add_head() {
    const DemoModel& planet = result_.models.front();
    add("<header>\n<h1>Any level of detail, exactly</h1>\n");
    add(fmt::format(
        "<p>One mesh of {} triangles became one file of {}, in {:.1f} seconds. Out of it "
        "comes every level between {} and {} triangles, each with an error that is a "
        "measured distance.</p>\n</header>\n",
        format_count(planet.triangles), format_bytes(planet.file_bytes), planet.build_seconds,
        format_count(planet.shown.back().triangles), format_count(planet.triangles)));
  }

  void add_main_model() {
    const DemoModel& planet = result_.models.front();
    add(fmt::format("<h2>{}</h2>\n<p>{}</p>\n", planet.shape.title, planet.shape.text));
    if (!result_.device.empty()) add_stage(planet);
    add(fmt::format(
        "<pre>{} -o planet.ply\nvarifold build pm planet.ply -o planet.vfm\n"
        "varifold extract planet.vfm --triangles {} -o level.ply\n"
        "varifold render planet.vfm --triangles {} --wireframe -o level.png</pre>\n",
        escaped(planet.shape.command), planet.shown[2].triangles, planet.shown[2].triangles));
    add_levels(planet);
  }

  // Two pictures beside each other, and a slider that goes through the levels.
  void add_stage(const DemoModel& model) {
    const std::size_t last = model.shown.size() - 1;
    add(
        fmt::format("<div class=\"control\"><span>coarse</span><input type=\"range\" id=\"level\" "
                    "min=\"0\" max=\"{}\" value=\"{}\" aria-label=\"Level of detail\">"
                    "<span>fine</span><output id=\"told\"></output></div>\n",
                    last, last - 2));
    for (std::size_t i = 0; i <= last; ++i) {
      const DemoLevel& level = model.shown[last - i];
      const std::string told = format_count(level.triangles) + " triangles, error " +
                               part_of(level.error, model) + " of the diagonal";
      add(fmt::format("<div class=\"stage\" data-level=\"{}\" data-told=\"{}\">\n", i, told));
      add_figure(level.shaded, "shaded: " + told, "<b>shaded</b>");
      add_figure(level.wired, "with edges: " + told, "<b>its triangles</b>");
      add("</div>\n");
    }
  }

  void add_levels(const DemoModel& model) {
    add("<table>\n<tr><th>level</th><th>triangles</th><th>vertices</th>"
        "<th>error, measured<br>(of the diagonal)</th><th>RMS distance<br>(both ways)</th>"
        "<th>bytes until it is there</th><th>time to extract<br>and write</th></tr>\n");
    for (const DemoLevel& level : model.shown)
      add(fmt::format(
          "<tr><td><a href=\"{}\">{}</a></td><td>{}</td><td>{}</td><td>{}</td>"
          "<td>{}</td><td>{}</td><td>{:.0f} ms</td></tr>\n",
          level.mesh_file, level.mesh_file, format_count(level.triangles),
          format_count(level.vertices), part_of(level.error, model), part_of(level.rms, model),
          format_bytes(level.stream_bytes), 1000 * level.extract_seconds));
    add("</table>\n");
  }

  void add_crowd() {
    if (!result_.crowd) return;
    const DemoCrowd& crowd = *result_.crowd;
    add("<h2>As fine as a pixel asks for</h2>\n");
    add(fmt::format(
        "<p>One model, {} instances. Each stands at the coarsest level whose error covers "
        "at most one pixel: {} triangles in all, instead of {}.</p>\n<div>\n",
        crowd.instances, format_count(crowd.triangles), format_count(crowd.full_triangles)));
    add_figure(crowd.picture, "a row of planets", "<b>what you see</b>");
    add("<br>\n");
    add_figure(crowd.wired_picture, "the same with edges", "<b>what is drawn</b>");
    add("</div>\n");
  }

  void add_stream() {
    add("<h2>While the file arrives</h2>\n<p>Every prefix of the file is a whole mesh. A reader "
        "refines as the bytes come.</p>\n<div class=\"row\">\n");
    for (const DemoPrefix& prefix : result_.prefixes)
      add_figure(prefix.picture, "a prefix",
                 fmt::format("<b>{:.0f} %</b> · {} · {} triangles", 100 * prefix.part,
                             format_bytes(prefix.bytes), format_count(prefix.triangles)));
    add("</div>\n");
    if (!result_.device.empty()) return;
    add("<table><tr><th>part</th><th>bytes</th><th>triangles</th></tr>\n");
    for (const DemoPrefix& prefix : result_.prefixes)
      add(fmt::format("<tr><td>{:.0f} %</td><td>{}</td><td>{}</td></tr>\n", 100 * prefix.part,
                      format_bytes(prefix.bytes), format_count(prefix.triangles)));
    add("</table>\n");
  }

  void add_others() {
    for (const DemoModel& model : std::span(result_.models).subspan(1)) {
      add(fmt::format("<h2>{}</h2>\n<p>{}</p>\n<div class=\"row\">\n", model.shape.title,
                      model.shape.text));
      for (const DemoLevel& level : model.shown)
        add_figure(level.wired, model.shape.title, caption(level, model));
      add("</div>\n");
      if (result_.device.empty()) add_levels(model);
    }
  }

  void add_strips() {
    const DemoStrips& strips = result_.strips;
    add("<h2>Triangle strips at every level</h2>\n<p>A strip names one vertex for each triangle "
        "after its first. LodStrips changes its strips in place from level to level.");
    add(result_.device.empty() ? "</p>\n" : " Each strip has a colour of its own.</p>\n");
    add("<div class=\"row\">\n");
    for (const DemoStripLevel& level : strips.levels)
      add_figure(level.picture, "strips, each in a colour of its own",
                 fmt::format("<b>{}</b> triangles · {} strips", format_count(level.triangles),
                             format_count(level.strips)));
    const DemoStripForm& drawn = strips.forms.front();
    add(
        fmt::format("</div>\n<pre>varifold generate planet --triangles 40000 -o {0}\n"
                    "varifold build lodstrips {0} -o {1}\nvarifold check {1}\n"
                    "varifold render {1} --color strip --triangles {2} -o strips.png</pre>\n",
                    strips.mesh_file, drawn.file, strips.levels.back().triangles));
    add_strip_table(strips);
  }

  // What each form sends at each level, and what it takes.
  void add_strip_table(const DemoStrips& strips) {
    add("<table>\n<tr><th>indices a triangle</th>");
    for (const DemoStripForm& form : strips.forms) add("<th>" + form.name + "</th>");
    add("<th>fresh strips<br>of that level alone</th></tr>\n");
    for (const DemoStripLevel& level : strips.levels) {
      add(fmt::format("<tr><td>{:.0f} % · {} triangles</td>", 100 * level.share,
                      format_count(level.triangles)));
      for (const double indices : level.indices) add(fmt::format("<td>{:.2f}</td>", indices));
      add(fmt::format("<td>{:.2f}</td></tr>\n", level.fresh_indices));
    }
    add_strip_bytes("bytes a vertex, model", &DemoStripForm::model_bytes);
    add_strip_bytes("bytes a vertex, instance", &DemoStripForm::instance_bytes);
    add_strip_bytes("bytes a vertex, file", &DemoStripForm::file_bytes);
    add("<tr><td>checked</td>");
    for (const DemoStripForm& form : strips.forms)
      add(fmt::format("<td class=\"{}\">{}</td>", is_sound(form.faults) ? "good" : "bad",
                      verdict(form)));
    add("<td></td></tr>\n</table>\n<p>A restart between any two strips is counted; a list of "
        "triangles has 3. The forms grouped and thesis send the same strips: those of the full "
        "mesh, best there and worse on the way down. The form of blocks, the default, "
        "grows its strips along with the splits.</p>\n");
  }

  void add_strip_bytes(const char* name, std::uint64_t DemoStripForm::*bytes) {
    add(fmt::format("<tr><td>{}</td>", name));
    for (const DemoStripForm& form : result_.strips.forms)
      add(fmt::format("<td>{:.1f}</td>", per_vertex(form.*bytes, result_.strips)));
    add("<td></td></tr>\n");
  }

  void add_builds() {
    add("<h2>The numbers</h2>\n<table>\n<tr><th>model</th><th>triangles</th><th>collapses</th>"
        "<th>whole build</th><th>in memory<br>bytes a vertex</th><th>file<br>bytes a vertex</th>"
        "<th>file</th><th>checked</th></tr>\n");
    for (const DemoModel& model : result_.models) {
      const double vertices = model.vertices;
      add(fmt::format(
          "<tr><td>{}</td><td>{}</td><td>{:.2f} s</td><td>{:.2f} s</td><td>{:.1f}</td>"
          "<td>{:.1f}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n",
          model.shape.title, format_count(model.triangles), model.simplify_seconds,
          model.build_seconds, static_cast<double>(model.model_bytes) / vertices,
          static_cast<double>(model.file_bytes) / vertices, format_bytes(model.file_bytes),
          is_sound(model.faults) ? "good" : "bad", verdict(model)));
    }
    add("</table>\n<p>Checked: levels reached from above, from below and directly have the same "
        "bytes; closed stays closed; same Euler characteristic; no flipped, doubled or degenerate "
        "triangle; the error holds.</p>\n");
  }

  template <class Checked>  // a model or a form of one
  static std::string verdict(const Checked& model) {
    if (is_sound(model.faults)) return fmt::format("sound, {} levels", model.levels_checked);
    std::string kinds;
    for (const Fault& fault : model.faults)
      if (fault.severity != Severity::kNote) kinds += (kinds.empty() ? "" : ", ") + fault.kind;
    return kinds;
  }

  const DemoResult& result_;
  const std::filesystem::path& folder_;
  std::string text_;
  Error fault_;
};

}  // namespace

Result<std::string> demo_page(const DemoResult& result, const std::filesystem::path& folder) {
  return PageWriter(result, folder).write();
}

}  // namespace varifold::cli
