"""What a user types after ./scripts/example is taken as typed, or refused."""

from support.typed import typing_tests

REFUSED = {
    "example car v=18,5": "the decimal mark is a point",
    "example suspended k_h=2,5": "the decimal mark is a point",
    "example car v=fast": "is not a number",
    "example car manoeuvre=loop": "is not one of",
    "example car s=-1": "must be",
    "example car slope=95deg": "must be",
    "example cra": "Do you mean ",
    "example car vv=5": "Do you mean ",
    "example car manoeuvre=lanes": "Do you mean ",
    "example car v=3 v=4": "given twice, as ",
    "example car v": "of the form",
    "example suspended h=1furlong": "it takes no unit but s or ms",
    "example car m_B=-1": "m_B = -1: it must be above 0 kg.",
    "example suspended h=0": "h = 0: it must be above 0 s.",
    "example suspended stop=1ms h=5ms": "stop = 0.001: it must be at least the step h, 0.005 s.",
    "example suspended mu_slide=0.4": "mu_slide = 0.4: it must be at most mu_max = 0.",
    "example control v=3": "this example takes no parameters",
}
TAKEN = ("example car path=1 v=18.5", "example suspended exchange=held")

test_a_fault_is_refused_in_one_sentence_with_status_2, test_what_is_meant_is_taken = typing_tests(REFUSED, TAKEN)
