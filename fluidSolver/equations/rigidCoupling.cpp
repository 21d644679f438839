// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/rigidCoupling.hpp"

namespace flotsam
{

double planeOrientation(const SimplexMesh& mesh)
{
    return (mesh.axes[1] - mesh.axes[0] + 3) % 3 == 1 ? 1 : -1;
}

void solidVelocity(const SimplexMesh& mesh, const Solid& solid, double* q) { toDegreesOfFreedom(mesh, solid.motion, q); }

void toDegreesOfFreedom(const SimplexMesh& mesh, const Motion& motion, double* q)
{
    const Vec3 &v = motion.velocity, &w = motion.angularVelocity;
    if (mesh.dim == 2)
    {
        q[0] = v[mesh.axes[0]];
        q[1] = v[mesh.axes[1]];
        q[2] = w[mesh.axes[2]];
        return;
    }
    for (int d = 0; d < 3; ++d) { q[d] = v[d]; q[3 + d] = w[d]; }
}

} // namespace flotsam
