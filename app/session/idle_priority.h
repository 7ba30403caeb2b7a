// Work that must cost nobody anything.
#pragma once

namespace saccade::app {

/// From now on the calling thread runs only while no other thread wants the core (Linux: SCHED_IDLE). For
/// good: an unprivileged thread cannot go back. Where the system has no such class it goes on as before.
void runAtIdlePriority();

}  // namespace saccade::app
