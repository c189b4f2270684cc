// glocal contract.
#include <gmock/gmock.h>

#include "app/program.hpp"

namespace glocal::test::contract_command_test {
namespace {

using testing::HasSubstr;

class ContractCommand : public CommandLine {};

TEST_F(ContractCommand, SaysThatAStrategyKeepsItsContract) {
  const Answer answer = good(run("contract clusterer dbscan"));
  EXPECT_EQ(answer.out, "clusterer dbscan: keeps its contract\n");
}

TEST_F(ContractCommand, TakesParameters) {
  good(run("contract threshold_policy fixed --set omega_max=0.3"));
  EXPECT_THAT(refusal(run("contract threshold_policy fixed --set omega_max=3")), HasSubstr("out of range"));
}

TEST_F(ContractCommand, SaysWhatIsBroken) {
  const Answer answer = run("contract matcher oracle --plugin " GLOCAL_TEST_PLUGINS "/every_kind.so");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.out, "");
  EXPECT_THAT(answer.err,
              HasSubstr("matcher oracle: breaks its contract: hypotheses: one has the quality 1"));
}

TEST_F(ContractCommand, RefusesWhatIsNotThere) {
  EXPECT_THAT(refusal(run("contract matchr ransam")), HasSubstr("did you mean 'matcher'?"));
  EXPECT_THAT(refusal(run("contract matcher ramsam")),
              HasSubstr("there is no matcher 'ramsam' (did you mean 'ransam'?)"));
}

}  // namespace
}  // namespace glocal::test::contract_command_test
