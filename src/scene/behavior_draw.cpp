#include "scene/behavior_draw.h"

#include "base/random.h"

namespace sumogamma {

BehaviorState draw_behavior(const AgentType& type, std::uint64_t seed, std::uint32_t id) {
  const Compliance& compliance = type.compliance;
  BehaviorState behavior;
  behavior.intention.kind = IntentionKind::Path;
  behavior.responsibility =
      random_uniform(seed, id, 0, Draw::Responsibility, compliance.responsibility_least,
                     compliance.responsibility_most);
  const double attention = random_uniform(seed, id, 0, Draw::Attention, compliance.attention_least,
                                          compliance.attention_most);
  behavior.attention = {attention * type.attention_front, attention * type.attention_rear};
  return behavior;
}

}  // namespace sumogamma
