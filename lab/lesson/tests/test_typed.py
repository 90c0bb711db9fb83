"""What a user types after ./scripts/view is taken as typed, or refused."""

from support.typed import typing_tests

REFUSED = {
    "view motion.csv --r_0 0,3 --r 0,05": "the decimal mark is a point",
    "view motion.csv --slope steep": "is not a number",
    "view motion.csv --slope 95deg": "must be",
    "view motion.csv --r_0 -1 --r 0": "must be",
    "view motion.csv --title a --title b": "given twice, as ",
    "view motion.csv --output motion.csv": "is read",
    "view motion.csv -o ./motion.csv": "is read",
    "view motion.csv --output thesis.html": "is not of this command",
}
FILES = {"motion.csv": "time,X_O\n0,0\n1,1\n", "thesis.html": "years of work"}
TAKEN = ("view motion.csv --slope 12% --r_0 30cm --r 5cm", "view motion.csv --output thesis.html --overwrite")


test_a_fault_is_refused_in_one_sentence_with_status_2, test_what_is_meant_is_taken = typing_tests(REFUSED, TAKEN, FILES)
