// What to tell a user whose mesh did not get as small as asked.
#pragma once

#include <varifold/simplify/collapser.h>
#include <varifold/simplify/simplify.h>

namespace varifold {

/// Looks at what is left of a surface after the last round. `all_done` says that no step is left
/// out of the log, so that it ended for want of legal collapses, if the target was not reached.
[[nodiscard]] StopReport report_stop(WorkingSurface& surface, Collapser& collapser,
                                     const SimplifyOptions& options, bool all_done);

}  // namespace varifold
