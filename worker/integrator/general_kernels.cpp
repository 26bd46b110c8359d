#include "worker/integrator/tile_kernel.h"

namespace treefarm {

template void render_tile<GeneralSurface>(const TileJob&, bool);

}  // namespace treefarm
