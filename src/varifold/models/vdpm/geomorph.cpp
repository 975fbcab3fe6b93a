#include <varifold/models/vdpm/geomorph.h>

#include <varifold/models/vdpm/step_regions.h>
#include <algorithm>
#include <array>

namespace varifold {

void FrontGeomorphs::advance(ActiveSurface& surface, std::uint32_t frames,
                             std::uint32_t max_triangles) {
  set_frames(std::clamp(frames, 1u, kMostFrames));
  if (!requests_.empty()) take_requests(surface);
  if (morphs_.empty()) return;
  if (max_triangles != kNone) keep_budget(surface, max_triangles);
  move(surface);
}

// Rounding up keeps the order of phases, and what is on its way on its way.
void FrontGeomorphs::set_frames(std::uint32_t frames) {
  if (frames == frames_) return;
  const auto scaled = [&](std::uint8_t count) {
    return static_cast<std::uint8_t>((count * frames + frames_ - 1) / frames_);
  };
  for (Morph& morph : morphs_) {
    morph.phase = scaled(morph.phase);
    morph.left = scaled(morph.left);
  }
  frames_ = frames;
}

// Steps that changed an even number of times are as they were. Which way the others go is what the
// surface and the morphs are not yet.
void FrontGeomorphs::take_requests(const ActiveSurface& surface) {
  std::sort(requests_.begin(), requests_.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i < requests_.size();) {
    std::size_t end = i + 1;
    while (end < requests_.size() && requests_[end] == requests_[i]) ++end;
    if ((end - i) % 2 == 1) requests_[count++] = requests_[i];
    i = end;
  }
  requests_.resize(count);
  events_.clear();
  arrived_.clear();  // here: those that the front splits
  phases_.clear();
  auto morph = morphs_.cbegin();
  for (const std::uint32_t step : requests_) {
    // Whether a step of the surface goes already is known from its first vertex.
    const std::uint32_t vertex = model_->first_vertex(step);
    morph = std::lower_bound(morph, morphs_.cend(), vertex, is_before);
    const bool moves = morph != morphs_.cend() && morph->vertex == vertex;
    if (!surface.is_split(step) || (moves && morph->goes))
      add_split(step, moves ? morph->phase : std::uint8_t{0});
    else
      add_events(step, Change::kGoes, model_->moves_vertices() && was_seen(step), 0);
  }
  requests_.clear();
  // Otherwise each step has vertices of its own, in the order of the steps.
  if (model_->moves_vertices())
    std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) {
      return a.vertex != b.vertex ? a.vertex < b.vertex : a.order < b.order;
    });
  merge_events(surface);
}

void FrontGeomorphs::add_split(std::uint32_t step, std::uint8_t phase) {
  const bool seen = was_seen(step);
  if (!seen) phase = std::max(phase, first_phase(step));
  add_events(step, Change::kAppears, seen, phase);
  arrived_.push_back(step);
  phases_.push_back(phase);
}

const FrontGeomorphs::Morph* FrontGeomorphs::find(std::uint32_t vertex) const {
  const auto morph = std::lower_bound(morphs_.begin(), morphs_.end(), vertex, is_before);
  return morph != morphs_.end() && morph->vertex == vertex ? &*morph : nullptr;
}

bool FrontGeomorphs::was_seen(std::uint32_t step) const {
  if (is_first_) return false;
  return !has_last_view_ ||
         last_view_.may_see(own_region(model_->bounds(step), model_->center(step)));
}

// Of a step that the front has split. Those of this frame that are before the one that asks are
// known.
std::uint8_t FrontGeomorphs::phase_of(std::uint32_t step) const {
  const auto known = arrived_.begin() + static_cast<std::ptrdiff_t>(phases_.size());
  const auto now = std::lower_bound(arrived_.begin(), known, step);
  if (now != known && *now == step)
    return phases_[static_cast<std::size_t>(now - arrived_.begin())];
  const Morph* morph = find(model_->first_vertex(step));
  return morph != nullptr ? morph->phase : static_cast<std::uint8_t>(frames_);
}

// Of a step that is split where nobody saw it: as far as what it requires is, so that the phase of
// that is never lower.
std::uint8_t FrontGeomorphs::first_phase(std::uint32_t step) const {
  auto phase = static_cast<std::uint8_t>(frames_);
  model_->for_each_required(
      step, [&](std::uint32_t required) { phase = std::min(phase, phase_of(required)); });
  return phase;
}

// As the rule has it: attributes are those of the last to write them, first of the collapses from
// fine to coarse, then of the splits.
void FrontGeomorphs::add_events(std::uint32_t step, Change change, bool slides,
                                std::uint8_t phase) {
  const ViewDependentMeshData& data = model_->data();
  const bool is_split = change == Change::kAppears;
  const std::uint32_t steps = model_->step_count();
  const std::uint32_t order = is_split ? steps + step : steps - 1 - step;
  const std::uint32_t first = model_->first_vertex(step), end = model_->first_vertex(step + 1);
  for (std::uint32_t v = first; v < end; ++v) {
    const std::uint32_t look = data.first_look.empty() ? kNone : data.first_look[v];
    events_.push_back({v, order, step, look, change, slides, phase});
  }
  if (!model_->moves_vertices()) return;
  for (std::uint32_t j = data.first_placed[step]; j < data.first_placed[step + 1]; ++j)
    events_.push_back({data.placed_vertex[j], order, step, is_split ? data.finer[j] : j,
                       Change::kMoves, slides, phase});
}

// Merges from the end, where there is room for those that are new.
void FrontGeomorphs::merge_events(const ActiveSurface& surface) {
  const ActiveVertices& vertices = surface.vertices();
  std::size_t from = morphs_.size(), to = from + count_new();
  reserve_for(morphs_, to);
  morphs_.resize(to);
  for (std::size_t end = events_.size(); end > 0;) {
    const std::uint32_t vertex = events_[end - 1].vertex;
    std::size_t first = end - 1;
    while (first > 0 && events_[first - 1].vertex == vertex) --first;
    while (from > 0 && morphs_[from - 1].vertex > vertex) morphs_[--to] = morphs_[--from];
    Morph changed{};
    if (from > 0 && morphs_[from - 1].vertex == vertex) {
      changed = morphs_[--from];
    } else {
      const bool is_there = vertices.is_active(vertex);
      changed.vertex = vertex;
      changed.slot = is_there ? vertices.slot(vertex) : kNone;
      changed.phase = is_there ? static_cast<std::uint8_t>(frames_) : std::uint8_t{0};
    }
    for (std::size_t i = first; i < end; ++i) apply(events_[i], vertices, changed);
    morphs_[--to] = changed;
    end = first;
  }
}

// How many vertices of the events do not move yet.
std::size_t FrontGeomorphs::count_new() const {
  std::size_t count = 0;
  auto morph = morphs_.begin();
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const std::uint32_t vertex = events_[i].vertex;
    if (i > 0 && events_[i - 1].vertex == vertex) continue;
    morph = std::lower_bound(morph, morphs_.end(), vertex, is_before);
    if (morph == morphs_.end() || morph->vertex != vertex) ++count;
  }
  return count;
}

void FrontGeomorphs::apply(const Event& event, const ActiveVertices& vertices, Morph& morph) const {
  switch (event.change) {
    case Change::kAppears:
      morph.step = event.step;
      morph.goes = false;
      morph.goal = event.look;
      morph.phase = event.phase;
      // Other numbers of frames may have brought one on its way out back to the last phase.
      morph.left = static_cast<std::uint8_t>(std::max(1u, frames_ - morph.phase));
      break;
    case Change::kGoes:
      morph.step = event.step;
      morph.goes = true;
      morph.goal = vertices.slot(model_->levels().target(morph.vertex));
      break;
    case Change::kMoves:
      if (morph.goes) break;
      morph.goal = event.look;
      morph.left =
          event.slides ? static_cast<std::uint8_t>(frames_) : std::max<std::uint8_t>(morph.left, 1);
  }
}

void FrontGeomorphs::keep_budget(const ActiveSurface& surface, std::uint32_t max_triangles) {
  const LevelTable& levels = model_->levels();
  std::array<std::uint32_t, kMostFrames + 1> going{};  // triangles, by phase
  std::uint32_t triangles = surface.triangle_count();
  for (const Morph& morph : morphs_) {
    if (morph.goes ? morph.vertex != model_->first_vertex(morph.step)
                   : morph.slot != kNone || morph.vertex != model_->first_vertex(morph.step))
      continue;
    if (morph.goes)
      going[morph.phase] += levels.step(morph.step).triangles;
    else
      triangles += levels.step(morph.step).triangles;
  }
  std::uint32_t last = 0;  // the greatest phase that goes at once
  while (triangles > max_triangles && last < frames_) triangles -= going[++last];
  for (Morph& morph : morphs_)
    if (morph.goes && morph.phase <= last) morph.phase = 1;
}

void FrontGeomorphs::move(ActiveSurface& surface) {
  const ViewDependentMeshData& data = model_->data();
  ActiveVertices& vertices = surface.vertices_to_move();
  arrived_.clear();
  std::size_t count = 0;
  for (Morph morph : morphs_) {
    if (morph.goes) {
      vertices.approach(morph.slot, vertices.buffer(), morph.goal, morph.phase);
      if (--morph.phase > 0)
        morphs_[count++] = morph;
      else if (morph.vertex == model_->first_vertex(morph.step))
        arrived_.push_back(morph.step);
      continue;
    }
    if (morph.slot == kNone) {
      if (!vertices.is_active(morph.vertex)) surface.split_connectivity(morph.step);
      morph.slot = vertices.slot(morph.vertex);
      const std::uint32_t target = vertices.slot(model_->levels().target(morph.vertex));
      vertices.write(morph.slot, vertices.buffer(), target);
    }
    if (morph.goal == kNone)
      vertices.approach(morph.slot, data.mesh, morph.vertex, morph.left);
    else
      vertices.approach(morph.slot, data.placed, morph.goal, morph.left);
    if (morph.phase < frames_) ++morph.phase;
    if (--morph.left > 0) morphs_[count++] = morph;
  }
  morphs_.resize(count);
  for (std::size_t i = arrived_.size(); i-- > 0;) surface.collapse_connectivity(arrived_[i]);
}

}  // namespace varifold
