// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/cutFlows.hpp"

#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

namespace flotsam
{

namespace
{

class OutsideOfCylinder : public Shape
{
public:
    explicit OutsideOfCylinder(double radius) : radius_(radius) {}
    double distance(const Vec3& x) const override { return radius_ - std::hypot(x[0], x[1]); }
    std::array<Vec3, 2> bounds() const override { return {Vec3::Constant(-1e3), Vec3::Constant(1e3)}; }
    VolumeMoments moments() const override { throw std::logic_error("OutsideOfCylinder: unbounded"); }
    TriSurface surface(double) const override { throw std::logic_error("OutsideOfCylinder: unbounded"); }

private:
    double radius_;
};

} // namespace

std::shared_ptr<const Shape> makeOutsideOfCylinder(double radius) { return std::make_shared<OutsideOfCylinder>(radius); }

double AnnularCouette::swirl() const
{
    const double a = innerRadius*innerRadius, b = outerRadius*outerRadius;
    return spin*a*b/(b - a);
}

ExactFlow AnnularCouette::flow(double rho) const
{
    const double B = swirl(), A = -B/(outerRadius*outerRadius);
    const Vec3 c = centre;
    ExactFlow exact;
    exact.isForced = false;
    exact.velocity = [A, B, c](const double* x, double, double* u)
    {
        const double dx = x[0] - c[0], dy = x[1] - c[1], rate = A + B/(dx*dx + dy*dy);
        u[0] = -rate*dy;
        u[1] = rate*dx;
    };
    exact.pressure = [A, B, c, rho](const double* x, double) // dp/dr = rho u^2/r
    {
        const double r2 = (x[0] - c[0])*(x[0] - c[0]) + (x[1] - c[1])*(x[1] - c[1]);
        return rho*(0.5*A*A*r2 + A*B*std::log(r2) - 0.5*B*B/r2);
    };
    return exact;
}

std::vector<Solid> AnnularCouette::solids() const
{
    std::vector<Solid> solids(2);
    solids[0].shape = makeOutsideOfCylinder(outerRadius);
    solids[1].shape = makeCylinder(Vec3(0, 0, -5), Vec3(0, 0, 5), innerRadius);
    solids[1].kind = Solid::Kind::Prescribed;
    solids[1].motion.angularVelocity = Vec3(0, 0, spin);
    for (Solid& s : solids) s.pose.position = centre;
    return solids;
}

/// A = (0, 0, sin(2x + 0.3) cos(1.7y)) in 2D, (sin 2y, sin(1.6z + 0.2), cos 1.8x) in 3D.
ExactFlow FlowAroundBody::flow() const
{
    ExactFlow exact;
    const Vec3 c = centre;
    const double R2 = radius*radius, scale = 5;
    const int d = dim;
    exact.velocity = [c, R2, scale, d](const double* x, double, double* u)
    {
        const Vec3 r(x[0] - c[0], x[1] - c[1], d == 3 ? x[2] - c[2] : 0);
        const double s = r.squaredNorm() - R2;
        Vec3 A, curl;
        if (d == 2)
        {
            A = Vec3(0, 0, std::sin(2*x[0] + 0.3)*std::cos(1.7*x[1]));
            curl = Vec3(-1.7*std::sin(2*x[0] + 0.3)*std::sin(1.7*x[1]), -2*std::cos(2*x[0] + 0.3)*std::cos(1.7*x[1]), 0);
        }
        else
        {
            A = Vec3(std::sin(2*x[1]), std::sin(1.6*x[2] + 0.2), std::cos(1.8*x[0]));
            curl = Vec3(-1.6*std::cos(1.6*x[2] + 0.2), 1.8*std::sin(1.8*x[0]), -2*std::cos(2*x[1]));
        }
        const Vec3 v = scale*(s*s*curl + 4*s*r.cross(A));
        for (int k = 0; k < d; ++k) u[k] = v[k];
    };
    exact.pressure = [d](const double* x, double)
    {
        return std::sin(2*x[0])*std::cos(2.5*x[1]) + (d == 3 ? std::sin(2*x[2] + 0.5) : 0);
    };
    return exact;
}

std::vector<Solid> FlowAroundBody::solids() const
{
    std::vector<Solid> solids(1);
    solids[0].shape = dim == 2 ? makeCylinder(Vec3(0, 0, -5), Vec3(0, 0, 5), radius) : makeSphere(Vec3::Zero(), radius);
    solids[0].pose.position = centre;
    return solids;
}

ErrorTable errorsAroundBody(int dim, const char* title, double rho, double mu, const std::vector<int>& sizes)
{
    usePetsc();
    ErrorTable table(title);
    for (int n : sizes)
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.12);
        const Halo halo(mesh, MPI_COMM_WORLD);
        FlowAroundBody body;
        body.dim = dim;
        body.centre = Vec3(0.513, 0.487, 0.52);
        NumericsControls controls;
        controls.timeOrder = 1;
        controls.tolerance = 1e-8;
        controls.restart = 200;
        controls.maxIterations = 2000;
        ForcedFlow flow(mesh, halo, oneFluid(rho, mu), controls, body.flow());
        const std::vector<Solid> solids = body.solids();
        CoverBuilder builder(mesh, flow.graph(), halo);
        flow.setGeometry(builder.build(solids), solids);
        CHECK(flow.toSteadyState(1e3, dim == 2 ? 1e-6 : 1e-5, 30) < 30);
        const FlowErrors e = flow.errors();
        table.add(1.0/n, {{"u L2", e.velocity}, {"u H1", e.gradient}, {"p L2", e.pressure}});
    }
    table.print();
    return table;
}

Vec3 haltonPoint(int k)
{
    const int bases[3] = {2, 3, 5};
    Vec3 point = Vec3::Zero();
    for (int d = 0; d < 3; ++d)
    {
        double digit = 1.0/bases[d];
        for (int i = k + 1; i > 0; i /= bases[d], digit /= bases[d]) point[d] += (i % bases[d])*digit;
    }
    return point;
}

} // namespace flotsam
