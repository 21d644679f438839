#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every mistake in a dictionary is refused with one message that names the place, what was found and what is allowed.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeFloatingBar good
(cd good && quietly flotsamFoam -dry-run) || exit
failures=0

# refused NAME 'COMMAND that makes the mistake' WORD...: the dry run must fail, its message must have all the words
refused() {
    local name=$1 mistake=$2 word log
    shift 2
    rm -rf "$name" && cp -r good "$name"
    (cd "$name" && eval "$mistake") || fail "could not make the mistake $name"
    log=$work/$name/log.dryRun
    if (cd "$name" && flotsamFoam -dry-run > "$log" 2>&1); then
        echo "$name: accepted" >&2
        failures=$((failures + 1))
        return
    fi
    for word in "$@"; do
        grep -q -- "$word" "$log" || {
            echo "$name: no '$word' in the message:" >&2
            sed -n '/FATAL/,$p' "$log" | head -n 15 >&2
            failures=$((failures + 1))
            return
        }
    done
}

refused keyword 'setNumerics . "nitscheGama 10;"' \
    fvSolution nitscheGama nitscheGamma
refused dimensions 'sed -i "s/nu .*/nu [1 -1 -1 0 0 0 0] 1e-3;/" constant/transportProperties' transportProperties.water.nu "behind the dimensions \[0 2 -1 0 0 0 0\]: it is the kinematic viscosity"
refused range 'setNumerics . "tolerance -1;"' \
    fvSolution tolerance -1
refused gravityAcross 'sed -i "s/(0 -9.81 0)/(0 0 -9.81)/" constant/g' 'constant/g is (0 0 -9.81), along z' 'for instance (0 -9.81 0)'
refused wallLaw 'setNumerics . "wallLaw on; wallGamma 0;"' \
    fvSolution wallLaw 'wallGamma is 0'
refused mixingWithoutLaw 'setNumerics . "mixingDepth 0.2;"' \
    fvSolution mixingDepth 'wallLaw is off' 'Set wallLaw on'
refused missingField 'rm 0/p_rgh' p_rgh
refused missingPhase 'rm 0/alpha.water' alpha.water 'is missing' setFields
refused functionObjectsFolder 'setEntry system/controlDict startFrom latestTime; mkdir 0.5; cp 0/U 0.5' 'Time 0.5 has no alpha.water' 'time 0 has' 'startTime 0;'
refused laterOnProcessors 'mkdir -p processor0/0.5' processor0 'holds time 0.5' 'reconstructPar -latestTime'
refused alphaRange 'sed "s/^internalField .*/internalField uniform 2;/" 0.orig/alpha.water > 0/alpha.water' alpha.water 'from 0 to 2' 'from 0 to 1'
refused missingTime 'setEntry system/controlDict startFrom startTime; setEntry system/controlDict startTime 0.7' \
    'Time folder' 0.7 'there are: 0$' startTime
refused unknownCondition 'sed -i "s/pressureInletOutletVelocity/waveVelocity/" 0/U' \
    waveVelocity atmosphere 'not available' pressureInletOutletVelocity
refused shutInflow 'sed -i "/atmosphere/,/}/ { s/pressureInletOutletVelocity/fixedValue/; s/(0 0 0)/(0 -0.1 0)/ }" 0/U; sed -i "s/totalPressure/fixedFluxPressure/" 0/p_rgh' \
    'given velocity (walls, atmosphere)\|given velocity (atmosphere)' 'bring in 0.002 m^3/s and take out 0' 'incompressible' 'totalPressure'
refused baffles 'printf "FoamFile { version 2.0; format ascii; class dictionary; object topoSetDict; }\nactions ( { name b; type faceZoneSet; action new; source searchableSurfaceToFaceZone; sourceInfo { surface searchablePlane; planeType pointAndNormal; pointAndNormalDict { point (0.1 0 0); normal (1 0 0); } } } );\n" > system/topoSetDict
    printf "FoamFile { version 2.0; format ascii; class dictionary; object createBafflesDict; }\ninternalFacesOnly true;\nbaffles { b { type faceZone; zoneName b; patches { master { name sheet; type wall; } slave { name sheetOther; type wall; } } } }\n" > system/createBafflesDict
    quietly topoSet && quietly createBaffles -overwrite' baffles 'patches sheet and sheetOther' 'mergeOrSplitBaffles -split'
refused turbulence 'sed -i "s/laminar;/RAS;/" constant/turbulenceProperties' RAS turbulenceProperties 'allowed: laminar'
refused bodyOutside 'sed -i "s/(0 0.001 0.025)/(0.5 0.001 0.025)/" constant/bodies' bar 'outside of the mesh'
refused overlap 'sed -i "s/    bar$/    copy { shape { type box; size (0.02 0.02 0.05); } density 590; position (0.01 0 0.025); }\n    bar/" constant/bodies' \
    bar copy into
refused unknownShape 'sed -i "s/type box/type bocks/" constant/bodies' bodies bocks box
refused unknownBodyKeyword 'sed -i "s/density/densty/" constant/bodies' densty density
refused noMesh 'rm -r constant/polyMesh' 'There is no mesh' polyMesh/points blockMesh
refused patchWithoutCondition 'sed -i "s/^    walls/    wals/" 0/U' 0/U "Patch 'walls' of the mesh has no condition" "'wals' (of walls?)"
refused forces 'echo "functions { drag { type forces; libs (forces); patches (walls); } }" >> system/controlDict' "'drag' of type forces" controlDict.functions.drag 'enabled no' 'wallForces { drag { patches'
refused wallForcesPatch 'echo "wallForces { dam { patches (wals); } }" >> system/controlDict' controlDict.wallForces.dam "'wals' is no patch" 'Walls of the mesh: walls' 'Did you mean: walls'
refused wallForcesOpen 'echo "wallForces { top { patches (atmosphere); } }" >> system/controlDict' controlDict.wallForces.top 'atmosphere is no wall' 'Walls of the mesh: walls'
refused wallForcesEmpty 'echo "wallForces { none { patches (); } }" >> system/controlDict' controlDict.wallForces.none 'at least one patch' 'walls of the mesh: walls'
refused otherTurbulence 'sed "s/laminar/RAS/; s/turbulenceProperties/momentumTransport/" constant/turbulenceProperties > constant/momentumTransport' RAS momentumTransport 'allowed: laminar'
refused wordForNumber 'sed -i "s/590;/wood;/" constant/bodies' "'density' is 'wood', but must be a number larger than 0" 'constant/bodies.bodies.bar.density at line 16'
refused posesWithoutGroups 'sed -i "s/position .*(0 0.001 0.025);/poses ( (0 0.001 0.025) );/" constant/bodies' "'poses' is" 'list of groups' constant/bodies.bodies.bar.poses
refused acrossMotion 'echo "structures { gate { shape { type box; size (0.02 0.05 0.05); } position (0.05 -0.05 0.025); motion { type linear; velocity (0 0 1); } } }" >> constant/bodies' \
    constant/bodies 'velocity of structure gate along z is 1; allowed: 0'
refused sameName 'sed -i "s/^    bar$/    bar { shape { type box; size (0.02 0.02 0.05); } density 700; position (0.05 0 0.025); }\n    bar/" constant/bodies' \
    constant/bodies "'bar' stands twice in 'bodies'" 'lines 12 and 13'
refused openStl 'mkdir -p constant/triSurface
    printf "solid open\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.01 0 0\nvertex 0 0.01 0\nendloop\nendfacet\nendsolid open\n" \
        > constant/triSurface/open.stl
    sed -i "s/type box; size (0.02 0.02 0.05);/type stl; file \"open.stl\";/" constant/bodies' \
    open.stl
refused writeInterval 'setEntry system/controlDict writeInterval 0' controlDict writeInterval 0
refused twoAcross 'sed -i "s/density/velocity (0.1 0 0.2); density/" constant/bodies' bodies '2D mesh' velocity bar 0.2 'allowed: 0'
refused twoTurn 'sed -i "s/density/angularVelocity (1 0 0); density/" constant/bodies' bodies '2D mesh' angularVelocity bar 'along x is 1'
refused twoShort 'sed -i "s/size (0.02 0.02 0.05)/size (0.02 0.02 0.03)/" constant/bodies' bar 'front to back'
refused twoBall 'sed -i "s/type box; size (0.02 0.02 0.05)/type sphere; radius 0.025/" constant/bodies' bar 'its section changes on the way' 'cylinder along z'

rm -rf pen && cp -r good pen
(cd pen && sed -i "s/^maxBodyCo/maxBodyCO/" system/controlDict && sed -i 's/^flotsam/flotsm/' system/fvSolution && quietly flotsamFoam -dry-run \
    && grep -q "entry 'maxBodyCO'. Did you mean: maxBodyCo" log.flotsamFoam && grep -q "entry 'flotsm'. Did you mean: flotsam" log.flotsamFoam) || fail "slips of the pen are not mentioned"
grep -q 'Did you mean\|arning: \|^  warning' good/log.flotsamFoam && fail "a warning in a good case"

# not of a dictionary: processes without -parallel, and a state of other bodies
(cd good && mpirun -np 2 flotsamFoam -dry-run) > alone.log 2>&1 && fail "processes without -parallel are accepted"
grep -q 'without the option -parallel' alone.log || fail "processes without -parallel: no word"
rm -rf other && cp -r good other
fixedSteps other 0.001 0.002 2
(cd other && quietly flotsamFoam && sed -i 's/^    bar$/    log/' constant/bodies) || exit
setEntry other/system/controlDict endTime 0.004
(cd other && sed 's/    log$/    bar/' constant/bodies > same && cp constant/bodies now && cp same constant/bodies && quietly flotsamFoam -dry-run && cp now constant/bodies) || exit
grep -q 'Start at time 0.002: the stored state continues, exactly' other/log.flotsamFoam || fail "the dry run does not say what it starts from"
(cd other && flotsamFoam -dry-run) > /dev/null 2>&1 && fail "the dry run accepts a state of other bodies"
(cd other && flotsamFoam) > other.log 2>&1 && fail "a state of other bodies is accepted"
grep -q 'does not go on from the stored state of time 0.002: bodies bar are missing' other.log || fail "a state of other bodies: no word"
rm -rf tiny && cp -r good tiny
setEntry tiny/system/controlDict maxBodyCo 1e-12
(cd tiny && flotsamFoam) > tiny.log 2>&1 && fail "a time step below minDeltaT is accepted"
grep -q 'time step falls to [0-9.]*e-[0-9]* s .* minDeltaT .* 1e-09 s: the surface of bar moves with .* maxBodyCo 1e-12' tiny.log || fail "a time step below minDeltaT: not what limits it"
setEntry tiny/system/controlDict maxBodyCo 0.5
setEntry tiny/system/controlDict maxCo 1e-12
(cd tiny && flotsamFoam) > tiny.log 2>&1 && fail "a time step of the flow below minDeltaT is accepted"
grep -q 'time step falls to [0-9.]*e-[0-9]* s .*: |u| = .* reduce maxCo' tiny.log || fail "a time step of the flow below minDeltaT: not what limits it"
rm -rf scientific && cp -r good scientific
setEntry scientific/system/controlDict timeFormat scientific
(cd scientific && quietly flotsamFoam -dry-run) || fail "the folder 0 is not found as time 0.0000e+00"
makeFallingSphere alone
sed -i 's/density /beforeRelease absent; density /' alone/constant/bodies
(cd alone && flotsamFoam -dry-run) > alone.log 2>&1 && fail "a body that comes in through one fluid is accepted"
grep -q 'absent before its release .* no gas' alone.log || fail "a body that comes in through one fluid: no word"
rm -rf misnamed && cp -r good misnamed && mv misnamed/constant/bodies misnamed/constant/bodiesDict
(cd misnamed && quietly flotsamFoam -dry-run && grep -q 'constant/bodiesDict is not read' log.flotsamFoam) || fail "a misnamed constant/bodies is not mentioned"
rm -rf headless && cp -r good headless && sed -i '/^FoamFile/,/^}/d' headless/constant/bodies
(cd headless && flotsamFoam -dry-run) > headless.log 2>&1 && fail "constant/bodies without a header is left out"
grep -q 'constant/bodies does not begin with a header: FoamFile {' headless.log || fail "constant/bodies without a header: no word"

rm -rf beside && cp -r good beside
echo 'structures { pier { shape { type cylinder; end1 (5 0 0); end2 (5 0 0.05); radius 0.01; } } }' >> beside/constant/bodies
(cd beside && quietly flotsamFoam -dry-run && grep -q 'structure pier lies outside of the mesh' log.flotsamFoam) || fail "a structure beside the mesh is not mentioned"
grep -q 'structure pier lies outside of the mesh.*scale' beside/log.flotsamFoam && fail "a small structure beside the mesh is taken for one in mm"
sed -i 's/end1 (5 0 0); end2 (5 0 0.05)/end1 (500 0 0); end2 (500 0 50)/' beside/constant/bodies
(cd beside && quietly flotsamFoam -dry-run && grep -q "structure pier lies outside of the mesh.* longer than the mesh.* 'scale 0.001'" log.flotsamFoam) || fail "a structure in mm beside the mesh: no word of its scale"
rm -rf shallow && cp -r good shallow
echo 'structures { pier { shape { type box; size (0.02 0.05 0.05); } position (0.07 -0.05 0); } }' >> shallow/constant/bodies
(cd shallow && quietly flotsamFoam -dry-run && grep -q 'Warning: 2D mesh: structures that are not the same from its front to its back, z = 0 to 0.05 m: pier\.' log.flotsamFoam) || fail "a structure that does not reach through a 2D mesh is not mentioned"
rm -rf upwards && cp -r good upwards
sed -i 's/(0 -9.81 0)/(0 9.81 0)/' upwards/constant/g
(cd upwards && quietly flotsamFoam -dry-run && grep -q 'Warning: water hangs at rest from the top of the mesh.*constant/g, (0 9.81 0), point downwards' log.flotsamFoam) || fail "a gravity that points upwards is not mentioned"
rm -rf relative && cp -r good relative
sed -i -e 's/ 1;/ 0.001;/' -e 's/ 1000;/ 1;/' relative/constant/transportProperties
(cd relative && quietly flotsamFoam -dry-run && grep -q 'rho of water is 1 kg/m^3, less than that of any liquid' log.flotsamFoam) || fail "densities over water's are not mentioned"
rm -rf equal && cp -r good equal
sed -i 's/ 1000;/ 1;/' equal/constant/transportProperties
(cd equal && quietly flotsamFoam -dry-run && grep -q 'both fluids have the density 1 kg/m^3' log.flotsamFoam) || fail "fluids of one density are not mentioned"
rm -rf kicked && cp -r good kicked
sed -i 's/uniform (0 0 0)/uniform (1 0 0)/' kicked/0/U
(cd kicked && quietly flotsamFoam -dry-run && grep -q 'Warning: body bar is let go at rest in a stream of 1 m/s' log.flotsamFoam) || fail "a body at rest in a stream is not mentioned"
rm -rf stray && cp -r good stray
(cd stray && foamDictionary -entry boundaryField/atmospher -set '{ type slip; }' 0/U > /dev/null && quietly flotsamFoam -dry-run \
    && grep -q "Warning: 0/U has conditions for what is no patch of the mesh: 'atmospher' (of atmosphere?)" log.flotsamFoam) || fail "a condition of no patch is not mentioned"
rm -rf letThrough && cp -r good letThrough
sed -i '/^    walls/,/}/s/type .*;/type zeroGradient;/' letThrough/0/U
(cd letThrough && quietly flotsamFoam -dry-run && grep -q 'patch walls is of type wall, but its U lets fluid through' log.flotsamFoam) || fail "a wall that lets fluid through is not mentioned"
rm -rf over && cp -r good over
setEntry over/system/controlDict endTime 0
(cd over && quietly flotsamFoam -dry-run && grep -q 'Nothing to do: the run is at 0 s, endTime of system/controlDict is 0 s' log.flotsamFoam) || fail "the dry run of nothing does not say so"
setEntry over/system/controlDict endTime 0.002
setEntry over/system/controlDict deltaT 0.01
setEntry over/system/controlDict adjustTimeStep no
(cd over && quietly flotsamFoam -dry-run && grep -q 'Nothing to do: .* is 0.002 s, not half a step of 0.01 s later' log.flotsamFoam) || fail "the dry run of less than half a step does not say so"
setEntry over/system/controlDict adjustTimeStep yes
(cd over && quietly flotsamFoam && ! grep -q 'Nothing to do' log.flotsamFoam && grep -qE '^ +[0-9]+ +0\.002 ' log.flotsamFoam) || fail "a first step longer than the run: $(tail -n 5 over/log.flotsamFoam)"
(cd over && setEntry system/controlDict writeControl timeStep && setEntry system/controlDict writeInterval 1 && quietly flotsamFoam \
    && setEntry system/controlDict endTime 0.0022 && setEntry system/controlDict maxDeltaT 0.0001 && quietly flotsamFoam && ! grep -q 'Nothing to do' log.flotsamFoam && [ -e 0.0022 ]) \
    || fail "a run that goes on for less than half of its last step, with a smaller maxDeltaT: $(tail -n 5 over/log.flotsamFoam)"
rm -rf dry && cp -r good dry
(cd dry && cp 0.orig/alpha.water 0/alpha.water && quietly flotsamFoam -dry-run && grep -q 'alpha.water of time 0 has no liquid' log.flotsamFoam) || fail "a tank without liquid is not mentioned"
rm -rf thin && cp -r good thin
echo 'structures { gate { shape { type box; size (1e-6 0.01 0.1); } position (0.0512345 0 0.025); } }' >> thin/constant/bodies
(cd thin && quietly flotsamFoam -dry-run && grep -q 'flow does not know of structures .* inside: gate\.' log.flotsamFoam) || fail "a structure between the nodes is not mentioned"

# steps of given length that are far too long for the flow: told once and counted, on one process and on two
makeCase damBreak long
(cd long && quietly blockMesh && quietly setFields && quietly decomposePar) || exit
for steps in '0.05 0.25' '0.02 0.1'; do
    fixedSteps long ${steps% *} ${steps#* } 100
    rm -rf long/0.[0-9]*
    for run in flotsamFoam 'mpirun -np 2 flotsamFoam -parallel'; do (cd long && quietly $run && cat log.[fm]* > log); done
    [ "${steps% *}" = 0.02 ] && { grep -q 'Courant number \(of\|above\) [0-9]' long/log && fail "a warning of steps that are not too long"; continue; }
    [ "$(grep -c 'Warning: t = 0.1 s: the step of 0.05 s, .* adjustTimeStep no, has a Courant number of 1[0-9.]*: |u| = .* deltaT of 0.0[0-9]* s at most' long/log)" -eq 2 ] || fail "steps that are too long: not told once a run"
    [ "$(grep -c '^  steps of a Courant number above 10  *[2-5]$' long/log)" -eq 2 ] || fail "steps that are too long: not counted in the summary"
done

# the same where maxCo lets them be as long
setEntry long/system/controlDict adjustTimeStep yes
setEntry long/system/controlDict maxCo 500
setEntry long/system/controlDict maxAlphaCo 500
setEntry long/system/controlDict maxDeltaT 0.05
setEntry long/system/controlDict endTime 0.4
rm -rf long/0.[0-9]*
(cd long && quietly flotsamFoam && grep -q 'warning  *maxCo 500 of system/controlDict lets the water cross 500 elements' log.flotsamFoam) || fail "a maxCo beyond sense is not mentioned"
[ "$(grep -c 'Warning: t = .* allowed by maxCo 500 and maxBodyCo 0.5, has a Courant number of 1[0-9.]*: |u| = .* Set maxCo' long/log.flotsamFoam)" -eq 1 ] || fail "steps that maxCo lets be too long: not told once"
grep -q '^  steps of a Courant number above 10  *[1-9]' long/log.flotsamFoam || fail "steps that maxCo lets be too long: not counted"

# a condition of a library of interFoam's
rm -rf angle && cp -r good angle
fixedSteps angle 0.001 0.002 1
sed '/^    walls/,/}/s/type .*;/type constantAlphaContactAngle; theta0 90; limit none; value uniform 0;/' angle/0.orig/alpha.water > angle/0/alpha.water
(cd angle && quietly setExprFields && quietly flotsamFoam && grep -q constantAlphaContactAngle 0.002/alpha.water && sed -i 's/^endTime .*/endTime 0.003;/' system/controlDict && quietly flotsamFoam \
    && quietly decomposePar -latestTime && sed -i 's/^endTime .*/endTime 0.004;/' system/controlDict && quietly mpirun -np 2 flotsamFoam -parallel) || fail "a contact angle of 90 degrees is not accepted"

# in parallel: said once, with the file
rm -rf once && cp -r good once
(cd once && quietly decomposePar && sed -i 's/density/densty/' constant/bodies && mpirun -np 2 flotsamFoam -parallel) > once.log 2>&1 && fail "an unknown keyword is accepted on two processes"
[ "$(grep -c "Unknown keyword 'densty'" once.log)" -eq 1 ] || fail "an unknown keyword on two processes: not said once"
grep -q 'file: .*/once/constant/bodies.bodies.bar ' once.log || fail "an unknown keyword on two processes: no file"

rm -rf gathered && cp -r good gathered
echo 'FoamFile { version 2.0; format ascii; class dictionary; object decomposeParDict; } numberOfSubdomains 2; method simple; coeffs { n (2 1 1); }' > gathered/system/decomposeParDict # OpenFOAM itself hangs in includes
(cd gathered && quietly decomposePar -fileHandler collated && timeout 60 mpirun -np 2 flotsamFoam -parallel -fileHandler collated) > gathered.log 2>&1 && fail "files that OpenFOAM gathers are accepted"
[ "$(grep -c 'fileHandler collated is not available: .* allowed: uncollated, masterUncollated' gathered.log)" -eq 1 ] || fail "files that OpenFOAM gathers: not said once"

(cd gathered && timeout 60 mpirun -np 2 flotsamFoam -parallel) > gathered.log 2>&1 && fail "a case that OpenFOAM has gathered is accepted"
grep -q 'There is no processor0, but .*gathered/processors2, as fileHandler collated decomposes, .*decomposePar -fileHandler uncollated' <(tr '\n' ' ' < gathered.log) || fail "a case that OpenFOAM has gathered: no word"

# a run that was killed while it wrote leaves a time that not every process has
rm -rf differing && cp -r good differing
setEntry differing/system/controlDict startFrom latestTime
(cd differing && quietly decomposePar && cp -r processor0/0 processor0/0.3 && cp -r processor0/0 processor0/0.2 && cp -r processor1/0 processor1/0.2
    timeout 60 mpirun -np 2 flotsamFoam -parallel) > differing.log 2>&1 && fail "processes with different latest times are accepted"
[ "$(grep -c 'FOAM FATAL' differing.log)" -eq 1 ] || fail "processes with different latest times: not said once"
grep -q 'different latest times: processor0 has 0.3, processor1 has 0.2\. ' differing.log && grep -q 'rm -r processor\*/0.3' differing.log || fail "processes with different latest times: no word"
# a folder that is not there was not left so: to remove the start of the others would not help
rm -r differing/processor0/0.[23] differing/processor1
(cd differing && timeout 60 mpirun -np 2 flotsamFoam -parallel) > differing.log 2>&1 && fail "a processor folder that is missing is accepted"
[ "$(grep -c 'FOAM FATAL' differing.log)" -eq 1 ] && grep -q 'differing/processor1 is missing, or has no time folder; processor0 has time 0\.' differing.log && ! grep -q 'rm -r' differing.log \
    || fail "a processor folder that is missing: $(tail -n 30 differing.log)"

# a gate that comes down on a bar on the bed: said when it happens, and the run that it ends names the gate
makeFloatingBar clamped
sed -i -e 's/590/1200/' -e 's/(0 0.001 0.025)/(0 -0.0895 0.025)/' -e '/orientation/d' clamped/constant/bodies
echo 'structures { gate { shape { type box; size (0.03 0.08 0.05); } position (0 -0.0385 0.025); motion { type linear; velocity (0 -0.1 0); } } }' >> clamped/constant/bodies
setEntry clamped/system/controlDict endTime 0.05
rm -rf clamped2 && cp -r clamped clamped2
(cd clamped2 && quietly decomposePar && mpirun -np 2 flotsamFoam -parallel) > clamped.log 2>&1 || fail "a gate that clamps a bar, on two processes"
grep -q 'Warning: t = 0.0[0-9]* s: the contact surfaces of body bar and .* overlap by .* Structure gate moves as prescribed' clamped.log || fail "a gate that clamps a bar: no warning on two processes"
setEntry clamped/system/controlDict endTime 0.5
(cd clamped && flotsamFoam) > clamped.log 2>&1 && fail "a gate goes through a bar"
[ "$(grep -c 'Warning: t = 0.0[0-9]* s: the contact surfaces of body bar and .* overlap by .* Structure gate moves as prescribed' clamped.log)" -eq 1 ] || fail "a gate that clamps a bar: not one warning"
grep -q 'no step could be made .* Structure gate moves as prescribed' clamped.log || fail "a gate that clamps a bar: the run that it ends does not name it"

# the tutorials' Allrun: says how it is used, runs nothing for options that it does not have
allrun=tree/tutorials/bridgePier
makeCase bridgePier $allrun
cp "$tutorials/bridgePier/Allrun" $allrun && cp "$tutorials/runFunctions" tree/tutorials && mkdir -p tree/scripts && cp "$here/../../scripts/environment.sh" tree/scripts || exit
(cd $allrun && ./Allrun -h) > allrun.log 2>&1 || fail "Allrun -h is an error"
grep -q '^Allrun \[-n N\] \[-r RESOLUTION\]' allrun.log && grep -q '^  -r RESOLUTION  quick' allrun.log || fail "Allrun -h does not say how it is used"
for wrong in two 0 -1 1.5; do
    (cd $allrun && ./Allrun -n $wrong) > allrun.log 2>&1 && fail "Allrun -n $wrong is accepted"
    grep -q -- "-n is '$wrong', but must be a whole number" allrun.log || fail "Allrun -n $wrong: no word"
done
[ ! -e $allrun/run ] || fail "Allrun runs in spite of a wrong option"

echo "$failures of the mistakes were not refused as promised"
[ $failures -eq 0 ]
