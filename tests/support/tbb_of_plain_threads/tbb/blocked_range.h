#pragma once
#include "tests/support/tbb_of_plain_threads/plain_threads.h"
