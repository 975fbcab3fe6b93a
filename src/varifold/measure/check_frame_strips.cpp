#include <varifold/measure/check_frame_strips.h>

#include <varifold/measure/model_checker.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/common/level_queries.h>
#include <varifold/view/draw_vertices.h>

namespace varifold {

namespace {

// One frame as a model by itself: vertices in the order of its sequence, in the shape of the frame.
class OneFrame : public LevelQueries<OneFrame> {
 public:
  OneFrame(std::shared_ptr<const FrameStrips> model, std::uint32_t frame)
      : model_(std::move(model)), frame_(frame) {
    const FrameStripsData& data = model_->data();
    const FrameSequence& sequence = model_->sequence_of(frame);
    attributes_ = blended_mesh(gather_vertices(data.mesh, sequence.vertex), weights());
    attributes_.ranges = data.mesh.ranges;
    attributes_.materials = data.mesh.materials;
    number_.resize(sequence.vertex.size());
    for (std::uint32_t i = 0; i < number_.size(); ++i) number_[sequence.vertex[i]] = i;
  }

  [[nodiscard]] const LevelTable& levels() const { return model_->sequence_of(frame_).levels; }
  [[nodiscard]] const TriangleMesh& attributes() const { return attributes_; }
  [[nodiscard]] std::size_t bytes() const { return model_->bytes(); }
  [[nodiscard]] const std::shared_ptr<const FrameStrips>& frames() const { return model_; }
  [[nodiscard]] std::uint32_t frame() const { return frame_; }
  /// Of the poses.
  [[nodiscard]] const std::vector<float>& weights() const {
    return model_->data().frames[frame_].weights;
  }
  [[nodiscard]] std::uint32_t number(std::uint32_t vertex) const { return number_[vertex]; }

 private:
  std::shared_ptr<const FrameStrips> model_;
  std::uint32_t frame_;
  TriangleMesh attributes_;
  std::vector<std::uint32_t> number_;  // per vertex of the mesh
};

class OneFrameInstance {
 public:
  explicit OneFrameInstance(std::shared_ptr<const OneFrame> model)
      : model_(std::move(model)), instance_(model_->frames()) {
    // By way of another frame, as a scene would.
    instance_.go_to_frame(model_->frames()->frame_count() - 1);
    static_cast<void>(instance_.draw_list());
    instance_.go_to_frame(model_->frame());
  }
  [[nodiscard]] const OneFrame& model() const { return *model_; }
  [[nodiscard]] std::uint32_t level() const { return instance_.level(); }
  void go_to_level(std::uint32_t level) { instance_.go_to_level(level); }
  [[nodiscard]] DrawList draw_list() {
    const DrawList drawn = instance_.draw_list();
    indices_.clear();
    for (const std::uint32_t v : drawn.indices)
      indices_.push_back(v == kStripRestart ? v : model_->number(v));
    DrawList list = draw_vertices(model_->attributes());
    list.indices = indices_;
    list.ranges = drawn.ranges;
    list.level = drawn.level;
    return list;
  }
  [[nodiscard]] TriangleMesh extract() const {
    return blended_mesh(instance_.extract(), model_->weights());
  }
  [[nodiscard]] std::size_t bytes() const { return instance_.bytes(); }

 private:
  std::shared_ptr<const OneFrame> model_;
  FrameStripsInstance instance_;
  std::vector<std::uint32_t> indices_;
};
static_assert(UniformModel<OneFrame> && UniformInstance<OneFrameInstance, OneFrame>);

}  // namespace

Result<ModelCheck> check_frame_strips(const std::shared_ptr<const FrameStrips>& model,
                                      const ModelCheckOptions& options) {
  ModelCheck all;
  for (std::uint32_t frame = 0; frame < model->frame_count(); ++frame) {
    const auto one = std::make_shared<const OneFrame>(model, frame);
    auto check = ModelChecker<OneFrameInstance>(one, options).run();
    if (!check) return check;
    all.levels_checked += check->levels_checked;
    all.distances_checked += check->distances_checked;
    for (Fault& fault : check->faults) {
      fault.kind = "frame_" + fault.kind;
      fault.where = "frame " + std::to_string(frame) + ": " + fault.where;
      all.faults.push_back(std::move(fault));
    }
  }
  return all;
}

}  // namespace varifold
