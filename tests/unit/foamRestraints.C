// SPDX-License-Identifier: GPL-3.0-or-later
/// `restraints` of constant/bodies: what is read, what is doubted, one message for every mistake.
#include "demCoupling/foam/restraintReader.H"
#include "support/bodiesScene.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <mpi.h>

using namespace flotsam;

namespace
{

const std::string logs = "bodies { boat { " + bar + "position (0.5 0.5 0.2); orientation { axis (0 0 1); angleDeg 90; } } log { " + bar
    + "array { count (3 1 1); spacing (0.3 0 0); } position (0.8 0.2 0.2); } }";
const std::string gates = "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.8 0.8 0.2); motion { type linear; velocity (0 -0.1 0); } }"
    " hidden { shape { type box; size (0.02 0.02 0.02); } position (0.1 0.9 0.2); contact off; motion { type linear; velocity (0 0.1 0); } }"
    " post { shape { type box; size (0.02 0.02 0.02); } position (1.2 0.9 0.2); } }";
const std::string type = "type tether; ", ends = "body boat; refAttachmentPt (0.5 0.6 0.2); anchor (0.5 0.9 0.2); ", stiff = "stiffness 1e4; damping 10; ";

std::string restraint(const std::string& contents) { return "restraints { mooring { " + contents + " } }"; }

} // namespace

TEST_CASE("a tether to a point, a spring between bodies, a tether to a structure that moves")
{
    BodiesScene s;
    const BodiesInput input = s.read(gates + logs + "restraints { mooring { " + type + ends + stiff + "length 0.26; breakingForce 500; }"
        " link { type linearSpring; body log.0; refAttachmentPt (0.9 0.2 0.2); otherBody log.1; otherRefAttachmentPt (1 0.2 0.2); " + stiff + "}"
        " tow { type tether; body log.2; refAttachmentPt (1.5 0.2 0.2); anchor (1.8 0.75 0.2); anchorStructure gate; " + stiff + "}"
        " fast { type tether; body log.2; refAttachmentPt (1.5 0.2 0.2); anchor (1.2 0.89 0.2); anchorStructure post; " + stiff + "} }");
    REQUIRE(input.restraints.size() == 4);
    const RestraintDefinition &mooring = input.restraints[0], &link = input.restraints[1], &tow = input.restraints[2], &fast = input.restraints[3];
    CHECK(mooring.name == "mooring");
    CHECK(mooring.kind == RestraintDefinition::Kind::Tether);
    CHECK(input.bodies[mooring.end.body].name == "boat");
    const Pose& pose = input.bodies[mooring.end.body].pose;
    CHECK((pose.position + pose.orientation*mooring.end.place - Vec3(0.5, 0.6, 0.2)).norm() < 1e-12);
    CHECK(std::abs(mooring.end.place.cwiseAbs().maxCoeff() - 0.1) < 1e-12);
    CHECK(mooring.other.body == -1);
    CHECK(mooring.other.mover == -1);
    CHECK(mooring.other.place == Vec3(0.5, 0.9, 0.2));
    CHECK(mooring.length == 0.26);
    CHECK(mooring.breakingForce == 500);
    CHECK(link.kind == RestraintDefinition::Kind::LinearSpring);
    CHECK(input.bodies[link.other.body].name == "log.1");
    CHECK(link.length == within(0.1, 1e-12));   // the distance at the start
    CHECK(link.breakingForce == std::numeric_limits<double>::infinity());
    REQUIRE(tow.other.mover == 0);
    CHECK(input.movers[0].name == "gate");
    CHECK((tow.other.place - Vec3(0, -0.05, 0)).norm() < 1e-12);
    CHECK(fast.other.mover == -1);
    CHECK(fast.other.place == Vec3(1.2, 0.89, 0.2));
    CHECK(doubtfulRestraints(input, 0, 1e-3).empty());
    reportRestraints(input, 0, 1e-3);
}

TEST_CASE("2D: points are those of the mid-plane")
{
    BodiesScene s(false);
    const BodiesInput input = s.read("bodies { boat { shape { type box; size (0.2 0.02 0.1); } density 600; position (0.5 0.5 0); } } restraints { mooring { " + type
        + "body boat; refAttachmentPt (0.4 0.5 7); anchor (0.2 0.5 -3); " + stiff + "} }");
    REQUIRE(input.restraints.size() == 1);
    CHECK(std::abs(input.restraints[0].end.place[2]) < 1e-12);
    CHECK(input.restraints[0].other.place[2] == input.bodies[0].pose.position[2]);
    CHECK(input.restraints[0].length == within(0.2, 1e-12));
}

TEST_CASE("one message for every mistake")
{
    BodiesScene s;
    const auto message = [&](const std::string& contents) { return s.message(gates + logs + restraint(contents)); };
    CHECK(message(type + ends + stiff).empty());
    CHECK(has(s.message(gates + logs + "restraints 3;"), "must be a group"));
    CHECK(has(s.message(gates + logs + "restraints { mooring 3; }"), "'mooring' must be a restraint"));
    CHECK(has(s.message(gates + restraint(type + ends + stiff)), "constant/bodies has none"));
    CHECK(has(message("type teather; " + ends + stiff), "Did you mean: tether"));
    CHECK(has(message(ends + stiff), "'type' is missing"));
    CHECK(has(message(type + ends + stiff + "restLength 1;"), "Unknown keyword 'restLength'"));
    CHECK(has(message("type linearSpring; " + ends + stiff + "length 1;"), "Unknown keyword 'length'"));
    CHECK(has(message(type + "body bota; refAttachmentPt (0.5 0.6 0.2); anchor (0.5 0.9 0.2); " + stiff), "Unknown body 'bota'"));
    CHECK(has(message(type + "body log; refAttachmentPt (0.5 0.6 0.2); anchor (0.5 0.9 0.2); " + stiff), "a group of 3 bodies: name one of them, log.0 to log.2"));
    CHECK(has(message(type + "body gate; refAttachmentPt (0.5 0.6 0.2); anchor (0.5 0.9 0.2); " + stiff), "anchorStructure gate;"));
    CHECK(has(message(type + "body boat; anchor (0.5 0.9 0.2); " + stiff), "'refAttachmentPt' is missing"));
    CHECK(has(message(type + "body boat; refAttachmentPt 3; anchor (0.5 0.9 0.2); " + stiff), "three numbers in round brackets"));
    CHECK(has(message(type + "body boat; refAttachmentPt (0.5 0.6 0.2); " + stiff), "Give the other end"));
    CHECK(has(message(type + ends + "otherBody log.0; otherRefAttachmentPt (0.8 0.2 0.2); " + stiff), "Give the other end: either"));
    CHECK(has(message(type + "body boat; refAttachmentPt (0.5 0.6 0.2); otherBody boat; otherRefAttachmentPt (0.5 0.4 0.2); " + stiff), "Both ends are at body 'boat'"));
    CHECK(has(message(type + "body boat; refAttachmentPt (0.5 0.6 0.2); otherBody log.0; otherRefAttachmentPt (0.8 0.2 0.2); anchorStructure gate; " + stiff), "'anchorStructure' goes with 'anchor'"));
    CHECK(has(message(type + ends + "anchorStructure gat; " + stiff), "Did you mean: gate"));
    CHECK(has(message(type + ends + "anchorStructure hidden; " + stiff), "has 'contact off'"));
    CHECK(has(message(type + ends + "stiffness -5; damping 0; "), "'stiffness' is -5: it must be larger than 0"));
    CHECK(has(message(type + ends + "damping 0; "), "'stiffness' is missing"));
    CHECK(has(message(type + ends + "stiffness 5; damping -1; "), "'damping' is -1"));
    CHECK(has(message(type + ends + stiff + "length -1; "), "'length' is -1"));
    CHECK(has(message(type + ends + stiff + "breakingForce 0; "), "'breakingForce' is 0"));
}

TEST_CASE("doubts: a point beside its body, an anchor far away, a restraint that breaks at once, a stiff one without damping")
{
    BodiesScene s;
    const std::string beside = "type tether; body boat; refAttachmentPt (0.5 0.8 0.2); anchor (0.5 0.9 0.2); ";
    auto doubts = doubtfulRestraints(s.read(logs + restraint(beside + stiff)), 0, 1e-3);
    REQUIRE(doubts.size() == 1);
    CHECK(has(doubts[0], "its point on body boat is 0.2 m outside of that"));
    doubts = doubtfulRestraints(s.read(logs + restraint("type tether; body boat; refAttachmentPt (0.5 0.6 0.2); anchor (500 900 200); " + stiff)), 0, 1e-3); // in mm
    REQUIRE(doubts.size() == 1);
    CHECK(has(doubts[0], "restraint mooring: its anchor is "));
    CHECK(has(doubts[0], " m away from the mesh"));
    CHECK(doubtfulRestraints(s.read(logs + restraint("type tether; body boat; refAttachmentPt (0.5 0.6 0.2); anchor (0.5 2.5 0.2); " + stiff)), 0, 1e-3).empty()); // on a bank outside
    doubts = doubtfulRestraints(s.read(logs + restraint(type + ends + stiff + "length 0.2; breakingForce 500;")), 0, 1e-3);
    REQUIRE(doubts.size() == 1);
    CHECK(has(doubts[0], "restraint mooring breaks at once: 1000 N at the start"));
    const BodiesInput stiffly = s.read(logs + restraint(type + ends + "stiffness 1e5; damping 0;"));
    doubts = doubtfulRestraints(stiffly, 0, 1e-3); // a bar of 0.096 kg pulled along its length: 6.16 ms
    REQUIRE(doubts.size() == 1);
    CHECK(has(doubts[0], "restraint mooring has a dry period of 0.00615624 s, of few steps of the fluid, and a damping ratio of 0"));
    CHECK(has(doubts[0], "damping 39.1918 would be a ratio of 0.2"));
    CHECK(doubtfulRestraints(stiffly, 0, 1e-4).empty());
}
