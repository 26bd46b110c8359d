#include "worker/integrator/tile_kernel.h"

namespace treefarm {

template void render_tile<DiffuseSurface>(const TileJob&, bool);

}  // namespace treefarm
