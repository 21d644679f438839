// SPDX-License-Identifier: GPL-3.0-or-later
/// A program of its own: what OpenFOAM aborts on ends with its message and an exit code of 1, without a stack trace and a signal. On several processes the message is said once. With -library OpenFOAM's own library aborts.
#include "foam/endOnErrors.H"

#include "IStringStream.H"
#include "argList.H"
#include "dictionary.H"
#include "dimensionSet.H"

int main(int argc, char* argv[])
{
    Foam::argList::noCheckProcessorDirectories();
    Foam::argList::addBoolOption("library", "abort within OpenFOAM's library");
    Foam::argList args(argc, argv, false, false);
    flotsam::endOnErrors();
    if (args.found("library")) Foam::trans(Foam::dimLength);
    Foam::IStringStream stream("nu [1 -1 -1 0 0 0 0] 1e-3;");
    Foam::dictionary dict(stream);
    dict.name() = "transportProperties";
    FatalIOErrorInFunction(dict) << "the dimensions of nu do not match" << Foam::abort(Foam::FatalIOError);
    return 0;   // what ctest would take for a success
}
