#include "road/sumo_letters.h"

namespace sumogamma {

TurnDirection direction_from_letter(char letter) {
  switch (letter) {
    case 'l':
      return TurnDirection::Left;
    case 'r':
      return TurnDirection::Right;
    case 'L':
      return TurnDirection::PartlyLeft;
    case 'R':
      return TurnDirection::PartlyRight;
    case 't':
      return TurnDirection::Turnaround;
    default:
      return TurnDirection::Straight;
  }
}

LinkPriority priority_from_letter(char letter) {
  switch (letter) {
    case 'M':
      return LinkPriority::Major;
    case 'm':
      return LinkPriority::Minor;
    case '=':
      return LinkPriority::Equal;
    case 's':
      return LinkPriority::Stop;
    case 'w':
      return LinkPriority::AllWayStop;
    case 'Z':
      return LinkPriority::Zipper;
    default:
      return LinkPriority::Other;
  }
}

Light light_from_letter(char letter) {
  switch (letter) {
    case 'r':
    case 'u':
      return Light::Red;
    case 'y':
    case 'Y':
      return Light::Amber;
    case 'g':
    case 'o':
      return Light::Green;
    case 's':
      return Light::StopThenGo;
    case 'G':
      return Light::GreenFirst;
    default:
      return Light::None;
  }
}

}  // namespace sumogamma
