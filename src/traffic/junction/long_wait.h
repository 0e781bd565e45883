#pragma once

#include "traffic/junction/encounter.h"

namespace sumogamma {

// Who goes first after a long wait, though the other has the right of way: each case as the one
// that goes sees it, and as the one that lets it go does.

/// Does the subject, on foot, step out before one that need not brake hard for it? Where they come
/// without end nobody else lets it.
bool steps_out(const Encounter& e);
/// Does the subject, on wheels, halt for a foe that has waited so at an unsignalled crossing? In a
/// queue that creeps over the crossing nobody's foot finds a place before one does.
bool lets_step_out(const Encounter& e);

/// Has the subject stood at its line, or on the junction behind it, for so long that it noses out
/// before who need not brake hard for it, where neither has a light?
bool noses_out(const Encounter& e);
/// Does the subject halt for a foe that has?
bool lets_nose_out(const Encounter& e);

/// Is the subject owed its way now, before one that need not brake hard for it? A cyclist that has
/// missed its green, or a vehicle on the junction that holds up who has the right of way.
bool goes_first(const Encounter& e);
/// Does the subject, which isn't owed its own, let such a foe go first?
bool lets_go_first(const Encounter& e);

/// Has a foe on wheels with the right of way stood for so long for others in the area that the
/// subject lets it come next, from its line? Else one after the other goes in there before it.
bool is_starved_by(const Encounter& e);

}  // namespace sumogamma
