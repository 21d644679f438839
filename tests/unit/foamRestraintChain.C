// SPDX-License-Identifier: GPL-3.0-or-later
/// `type chain` of `restraints`: the lines that it stands for, one message for every mistake.
#include "demCoupling/foam/restraintReader.H"
#include "support/bodiesScene.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <mpi.h>

using namespace flotsam;

namespace
{

// bars of 0.2 m along x, 0.1 m apart, and one that is turned about by half a turn
const std::string logs = "bodies { log { " + bar + "array { count (3 1 1); spacing (0.3 0 0); } position (0.5 0.2 0.2); } boat { " + bar
    + "position (1.4 0.2 0.2); orientation { axis (0 1 0); angleDeg 180; } } }";
const std::string gates = "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.8 0.8 0.2); motion { type linear; velocity (0 -0.1 0); } } }";
const std::string type = "type chain; links tether; ", ends = "front (-0.1 0 0); back (0.1 0 0); ", stiff = "stiffness 1e4; damping 10; ";

std::string chain(const std::string& contents) { return "restraints { boom { " + contents + " } }"; }

std::string bodyOf(const RestraintEnd& end, const BodiesInput& input) { return end.body < 0 ? "" : input.bodies[end.body].name; }

Vec3 placeOf(const RestraintEnd& end, const BodiesInput& input)
{
    if (end.body < 0) return end.place;
    const Pose& pose = input.bodies[end.body].pose;
    return pose.position + pose.orientation*end.place;
}

void checkSame(const RestraintDefinition& a, const RestraintDefinition& b)
{
    CHECK(a.kind == b.kind);
    for (const auto& [left, right] : {std::pair(a.end, b.end), std::pair(a.other, b.other)})
    {
        CHECK(left.body == right.body);
        CHECK(left.mover == right.mover);
        CHECK((left.place - right.place).norm() < 1e-12);
    }
    CHECK(a.length == within(b.length, 1e-12));
    CHECK(a.stiffness == b.stiffness);
    CHECK(a.damping == b.damping);
    CHECK(a.breakingForce == b.breakingForce);
}

} // namespace

TEST_CASE("a chain is its lines, written one by one")
{
    BodiesScene s;
    const BodiesInput input = s.read(gates + logs + chain(type + "bodies log; " + ends + stiff + "breakingForce 500; firstAnchor (0.2 0.2 0.2); lastAnchor (1.8 0.75 0.2); lastAnchorStructure gate;"));
    const std::string line = "type tether; breakingForce 500; " + stiff;
    const BodiesInput singly = s.read(gates + logs + "restraints { a { " + line + "body log.0; refAttachmentPt (0.4 0.2 0.2); anchor (0.2 0.2 0.2); }"
        " b { " + line + "body log.0; refAttachmentPt (0.6 0.2 0.2); otherBody log.1; otherRefAttachmentPt (0.7 0.2 0.2); }"
        " c { " + line + "body log.1; refAttachmentPt (0.9 0.2 0.2); otherBody log.2; otherRefAttachmentPt (1 0.2 0.2); }"
        " d { " + line + "body log.2; refAttachmentPt (1.2 0.2 0.2); anchor (1.8 0.75 0.2); anchorStructure gate; } }");
    REQUIRE(input.restraints.size() == 4);
    for (int i = 0; i < 4; ++i)
    {
        CHECK(input.restraints[i].name == "boom." + std::to_string(i));
        checkSame(input.restraints[i], singly.restraints[i]);
    }
    CHECK(input.restraints[3].other.mover == 0);
    CHECK(doubtfulRestraints(input, 0, 1e-3).empty());
}

TEST_CASE("names, groups and patterns in the order of the chain; a point and a value for each")
{
    BodiesScene s;
    const BodiesInput input = s.read(logs + chain("type chain; links linearSpring; bodies (boat \"log\\.[12]\" log.0); front ((-0.1 0 0) (0.1 0 0) (0.1 0 0) (0.1 0 0)); back ((0.1 0 0) (-0.1 0 0) (-0.1 0 0) (-0.1 0 0));"
        " restLength (0.05 0.06 0.07); damping (1 2 3); stiffness 1e4;"));
    REQUIRE(input.restraints.size() == 3);
    const char* const from[] = {"boat", "log.1", "log.2"};
    const char* const to[] = {"log.1", "log.2", "log.0"};
    for (int i = 0; i < 3; ++i)
    {
        const RestraintDefinition& r = input.restraints[i];
        CHECK(r.kind == RestraintDefinition::Kind::LinearSpring);
        CHECK(bodyOf(r.end, input) == from[i]);
        CHECK(bodyOf(r.other, input) == to[i]);
        CHECK(r.length == near(0.05 + 0.01*i, 1e-15));
        CHECK(r.damping == 1 + i);
    }
    CHECK((placeOf(input.restraints[0].end, input) - Vec3(1.3, 0.2, 0.2)).norm() < 1e-12);  // turned with the boat
    CHECK((placeOf(input.restraints[0].other, input) - Vec3(0.9, 0.2, 0.2)).norm() < 1e-12);
}

TEST_CASE("points are in the frame of the shape, not in that of the centre of mass")
{
    BodiesScene s;
    const std::string skirted = "bodies { float { shape { type union; parts { tube { type box; size (0.2 0.02 0.04); } skirt { type box; size (0.2 0.1 0.01); centre (0 -0.06 0); } } } density 300;"
        " array { count (2 1 1); spacing (0.3 0 0); } position (0.5 0.5 0.2); orientation { axis (0 1 0); angleDeg 0; } } }";
    const BodiesInput input = s.read(skirted + chain(type + "bodies float; " + ends + stiff));
    REQUIRE(input.restraints.size() == 1);
    CHECK(std::abs(input.bodies[0].pose.position[1] - 0.5) > 0.01);     // the centre of mass is lower
    CHECK((placeOf(input.restraints[0].end, input) - Vec3(0.6, 0.5, 0.2)).norm() < 1e-12);
    CHECK((placeOf(input.restraints[0].other, input) - Vec3(0.7, 0.5, 0.2)).norm() < 1e-12);
}

TEST_CASE("doubts: front and back exchanged")
{
    BodiesScene s;
    const auto doubts = doubtfulRestraints(s.read(logs + chain(type + "bodies log; front (0.1 0 0); back (-0.1 0 0); " + stiff)), 0, 1e-3);
    REQUIRE(doubts.size() == 1);
    CHECK(has(doubts[0], "chain boom: with front and back exchanged its bodies would be nearer to each other, 0.2 m of lines between them instead of 1 m"));
}

TEST_CASE("a closed chain; 2D")
{
    BodiesScene s;
    const BodiesInput ring = s.read(logs + chain(type + "bodies log; closed yes; " + ends + stiff));
    REQUIRE(ring.restraints.size() == 3);
    CHECK(bodyOf(ring.restraints[2].end, ring) == "log.2");
    CHECK(bodyOf(ring.restraints[2].other, ring) == "log.0");
    BodiesScene plane(false);
    const BodiesInput flat = plane.read("bodies { boat { shape { type box; size (0.2 0.02 0.1); } density 600; position (0.5 0.5 0); } } "
        + chain(type + "bodies boat; firstAnchor (0.2 0.5 -3); front (-0.1 0 7); back (0.1 0 7); " + stiff));
    REQUIRE(flat.restraints.size() == 1);
    CHECK(flat.restraints[0].length == within(0.2, 1e-12));
}

TEST_CASE("one message for every mistake")
{
    BodiesScene s;
    const auto message = [&](const std::string& contents) { return s.message(gates + logs + chain(contents)); };
    CHECK(message(type + "bodies log; " + ends + stiff).empty());
    CHECK(has(message("type chain; bodies log; " + ends + stiff), "'links' is missing: it must be one of: tether, linearSpring"));
    CHECK(has(message("type chain; links chain; bodies log; " + ends + stiff), "Unknown kind of links 'chain'"));
    CHECK(has(message(type + "bodies log; " + ends + stiff + "restLength 1;"), "Unknown keyword 'restLength'"));
    CHECK(has(message(type + "body log; " + ends + stiff), "Unknown keyword 'body'"));
    CHECK(has(message(type + ends + stiff), "'bodies' is missing"));
    CHECK(has(message(type + "bodies (); " + ends + stiff), "'bodies' is empty"));
    CHECK(has(message(type + "bodies 3; " + ends + stiff), "Entry 'bodies' is '3'"));
    CHECK(has(message(type + "bodies lgo; " + ends + stiff), "Did you mean: log"));
    CHECK(has(message(type + "bodies \"pile.*\"; " + ends + stiff), "which no body matches"));
    CHECK(has(message(type + "bodies gate; " + ends + stiff), "Unknown body or group of bodies 'gate'"));
    CHECK(has(message(type + "bodies (log log.1); " + ends + stiff), "names log.1 twice"));
    CHECK(has(message(type + "bodies log; back (0.1 0 0); " + stiff), "'front' is missing"));
    CHECK(has(message(type + "bodies log; front ((0 0 0) (0 0 0)); back (0.1 0 0); " + stiff), "'front' lists 2 points for 3 bodies"));
    CHECK(has(message(type + "bodies log; front 0; back (0.1 0 0); " + stiff), "'front' is '0', but must be a point"));
    CHECK(has(message(type + "bodies boat; " + ends + stiff), "A chain of one body, boat, needs"));
    CHECK(has(message(type + "bodies log; closed yes; lastAnchor (1 0 0); " + ends + stiff), "remove 'lastAnchor', or 'closed'"));
    CHECK(has(message(type + "bodies log; lastAnchorStructure gate; " + ends + stiff), "goes with 'lastAnchor (x y z)'"));
    CHECK(has(message(type + "bodies log; lastAnchor (1.8 0.75 0.2); lastAnchorStructure gat; " + ends + stiff), "Did you mean: gate"));
    CHECK(has(message(type + "bodies log; " + ends + "damping 1;"), "'stiffness' is missing"));
    CHECK(has(message(type + "bodies log; " + ends + "damping 1; stiffness (1 2 3);"), "'stiffness' lists 3 numbers, and the chain has 2 lines"));
    CHECK(has(message(type + "bodies log; " + ends + "damping 1; stiffness (1 -2);"), "'stiffness' is -2: it must be larger than 0"));
    CHECK(has(message(type + "bodies log; " + ends + "damping many; stiffness 1;"), "'damping' is 'many', but must be a number"));
    CHECK(has(s.message(logs + "restraints { boom.0 { type tether; body log.0; refAttachmentPt (0.4 0.2 0.2); anchor (0.2 0.2 0.2); " + stiff + "} boom { " + type + "bodies log; " + ends + stiff + "} }"),
        "Two restraints are called 'boom.0'"));
}
