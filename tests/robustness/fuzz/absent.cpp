// Every function without an instance: a null pointer is answered by fmi2Error, and nothing else happens.
#include <cstring>

#include "session.hpp"

namespace fuzz {
namespace {

constexpr fmi2Component none = nullptr;

void expect_error(std::initializer_list<fmi2Status> statuses) {
  for (const fmi2Status status : statuses) expect(status == fmi2Error, "a call without an instance is an error");
}

void life_cycle() {
  expect_error(
      {fmi2SetDebugLogging(none, fmi2True, 0, nullptr), fmi2SetupExperiment(none, 0, 0, 0, 0, 0),
       fmi2EnterInitializationMode(none), fmi2ExitInitializationMode(none), fmi2Terminate(none), fmi2Reset(none),
       fmi2DoStep(none, 0, 0.1, fmi2True), fmi2CancelStep(none), fmi2GetStatus(none, fmi2DoStepStatus, nullptr),
       fmi2GetRealStatus(none, fmi2DoStepStatus, nullptr), fmi2GetIntegerStatus(none, fmi2DoStepStatus, nullptr),
       fmi2GetBooleanStatus(none, fmi2DoStepStatus, nullptr), fmi2GetStringStatus(none, fmi2DoStepStatus, nullptr)});
}

void values() {
  expect_error({fmi2GetReal(none, nullptr, 0, nullptr), fmi2GetInteger(none, nullptr, 0, nullptr),
                fmi2GetBoolean(none, nullptr, 0, nullptr), fmi2GetString(none, nullptr, 0, nullptr),
                fmi2SetReal(none, nullptr, 0, nullptr), fmi2SetInteger(none, nullptr, 0, nullptr),
                fmi2SetBoolean(none, nullptr, 0, nullptr), fmi2SetString(none, nullptr, 0, nullptr),
                fmi2SetRealInputDerivatives(none, nullptr, 0, nullptr, nullptr),
                fmi2GetRealOutputDerivatives(none, nullptr, 0, nullptr, nullptr),
                fmi2GetDirectionalDerivative(none, nullptr, 0, nullptr, 0, nullptr, nullptr)});
}

void states_and_model_exchange() {
  expect_error({fmi2GetFMUstate(none, nullptr), fmi2SetFMUstate(none, nullptr), fmi2FreeFMUstate(none, nullptr),
                fmi2SerializedFMUstateSize(none, nullptr, nullptr), fmi2SerializeFMUstate(none, nullptr, nullptr, 0),
                fmi2DeSerializeFMUstate(none, nullptr, 0, nullptr), fmi2EnterEventMode(none),
                fmi2NewDiscreteStates(none, nullptr), fmi2EnterContinuousTimeMode(none),
                fmi2CompletedIntegratorStep(none, 0, nullptr, nullptr), fmi2SetTime(none, 0),
                fmi2SetContinuousStates(none, nullptr, 0), fmi2GetDerivatives(none, nullptr, 0),
                fmi2GetEventIndicators(none, nullptr, 0), fmi2GetContinuousStates(none, nullptr, 0),
                fmi2GetNominalsOfContinuousStates(none, nullptr, 0)});
}

}  // namespace

void Session::call_without_instance() {
  expect(!std::strcmp(fmi2GetVersion(), "2.0"), "the version is that of FMI 2");
  expect(!std::strcmp(fmi2GetTypesPlatform(), "default"), "the types are the default ones");
  life_cycle();
  values();
  states_and_model_exchange();
  fmi2FreeInstance(none);
}

}  // namespace fuzz
