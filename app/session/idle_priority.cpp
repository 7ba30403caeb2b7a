#include "app/session/idle_priority.h"

#include <pthread.h>
#include <sched.h>

namespace saccade::app {

void runAtIdlePriority() {
#ifdef SCHED_IDLE
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);  // refused: as before, as the header says
#endif
}

}  // namespace saccade::app
