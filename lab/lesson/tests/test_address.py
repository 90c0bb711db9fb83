"""A link is a state: what was chosen on the live page is in its address, and opened elsewhere it is the same."""

import pytest

from .pages import change, column, do, opened, start, value

LINK = "page.live.link.write()"
BITS = "page.wheels.map(({table}) => Object.values(table.columns).map((column) => [...column].join()).join())"
SHOWN = "[page.switches.show, page.plots.portrait.name, page.choice, page.player.t, page.live.plan]"


def test_a_link_opened_elsewhere_shows_the_same_motion_to_the_bit(live, live_file, window):
    start(live, theta_start=live.evaluate("61.5 / (180 / Math.PI)"), psi_dot_start=0.1 + 0.2)
    live.evaluate("page.live.setBody('disc'); page.live.compute(); page.live.keep(true)")
    for t, what in ((0, {"s": 0.0125}), (1.23, {"M_3": -3.1}), (2.57, {"M_3": 0}), (4.01, {"M_brake": 2})):
        do(live, t, **what)
    live.evaluate("page.switches.flip('force'); page.switches.flip('follow'); page.plots.portrait.choose('path')")
    live.evaluate("page.choose(1); page.player.seek(3.37)")
    link = live.evaluate(LINK)
    assert link == (
        "body=disc&theta=61.5deg&psi_dot=0.30000000000000004&s=0.0125&M_3=1.23:-3.1,2.57:0&M_brake=4.01:2&kept=yes"
        "&kept.body=disc&kept.theta=61.5deg&kept.psi_dot=0.30000000000000004&show=path+force&diagram=path&view=2&t=3.37"
    )
    bits, shown = live.evaluate(BITS), live.evaluate(SHOWN)
    with opened(window, live_file, link) as other:
        assert [other.evaluate(what) for what in (BITS, SHOWN, LINK)] == [bits, shown, link]
        other.evaluate("page.live.setStart('psi_dot_start', 0.3); page.live.compute()")
        assert other.evaluate(BITS) != bits


def follow(page, text: str) -> None:
    page.evaluate("(text) => { location.hash = text; }", text)
    page.wait_for_function("(text) => page.live.link.text === text || page.live.refusal", arg=text)


@pytest.mark.parametrize(("step", "speed", "place"), [(2, 1, "beside"), (3, 0.25, "behind"), (10, 0.5, "beside")])
def test_the_address_names_the_step_of_the_story_that_is_shown_at_its_speed(live, step, speed, place):
    follow(live, f"step={step}")
    assert live.evaluate("[page.live.step, page.player.speed, page.stage.place]") == [step - 1, speed, place]
    assert live.evaluate(LINK) == f"step={step}"
    change(live, phi_dot_start=-1)
    assert live.evaluate(LINK).startswith(("theta=", "phi_dot=-1"))


def test_the_page_writes_what_the_reader_does_into_its_address(live):
    start(live, s=0.03, at=2.5)
    live.wait_for_function("location.hash.startsWith('#s=0.03') && location.hash.endsWith('&t=2.5')")
    live.evaluate("page.player.play()")
    live.wait_for_function("/&t=(2.[6-9]|3)/.test(location.hash)")  # while it plays, too


def test_steps_of_the_story_and_scenes_are_places_to_which_the_browser_goes_back(live):
    follow(live, "step=1")
    for _ in range(2):
        live.locator("#live [name=next]").click()
    live.locator("#live [name=scenes]").click()
    live.locator("#presets button").first.click()
    live.evaluate("page.player.pause()")
    assert value(live, "phi_dot_start") == -2
    back = "page.live.link.text === page.live.link.write() && (history.back() ?? true)"  # a change would cancel it
    live.wait_for_function(back)
    live.wait_for_function("page.live.value('phi_dot_start') === -6")  # of the third step, beside the scenes
    for step in (2, 1):
        live.wait_for_function(back)
        live.wait_for_function("(step) => page.live.step === step - 1 && page.live.open", arg=step)
    live.evaluate("history.forward()")
    live.wait_for_function("page.live.step === 1 && page.live.open")


WRONG = {
    "no number": ("s=abc", "s = abc is no number"),
    "beyond the limits": ("s=-1", "s = -1 is not between 0 and 100"),
    "beyond the limits, in degrees": ("theta=200deg", "theta_start = 200° is not between 0° and 180°"),
    "an unknown name": ("speed=3", "speed, which the wheel has not"),
    "what may not be set": ("formulation=3", "formulation, which cannot be set"),
    "a name of the language": ("__proto__=3", "__proto__, which the wheel has not"),
    "a script": ("s=<img src=x onerror=alert(1)>", "s = <img src=x onerror=a is no number"),
    "after the end": ("M_3=11:1", "the time of M_3 = 11"),
    "no such body": ("body=ball", "no body ball"),
    "a body and one of its moments": ("body=disc&J_z=1", "J_z follows from m, r_0 and r"),
    "no such step": ("step=99", "no step 99"),
    "no such diagram": ("diagram=pie", "no diagram pie"),
    "a stray escape": ("%E0%A4%A", "which the wheel has not"),
    "no such part": ("show=path+ghost", "ghost"),
}
READ = """(text) => import('#address')
  .then(({read}) => read(text, page.live.link.states)).catch(({message}) => message)"""


@pytest.mark.parametrize("fault", WRONG)
def test_a_wrong_address_is_refused_with_one_sentence(live, fault):
    text, sentence = WRONG[fault]
    message = live.evaluate(READ, text)
    assert sentence in message and "\n" not in message and message.endswith(".") and len(message) < 150


@pytest.mark.parametrize(("text", "sentence"), [WRONG["a script"], ("J_x=90", "Jx, Jy, Jz = 90")])
def test_a_wrong_address_gives_the_first_scene_and_says_why(live, text, sentence):
    follow(live, "s=0.02")
    live.evaluate("(text) => { location.hash = text; }", text)
    live.wait_for_function("!document.querySelector('#refusal').hidden")
    message = live.locator("#refusal").inner_text()
    assert sentence in message and message.startswith("This address cannot be shown: ")
    assert live.evaluate("[page.live.step, page.live.trouble]") == [0, None]
    assert column(live, "phi_dot")[0] == pytest.approx(-2.368)
    live.locator("#live [name=next]").click()
    live.wait_for_function("document.querySelector('#refusal').hidden")


@pytest.mark.parametrize("word", ["true", "1"])
def test_a_wheel_carrier_is_written_true_and_read_either_way(live, word):
    start(live)
    live.evaluate("(word) => { location.hash = `guided=${word}&theta=90deg`; }", word)
    live.wait_for_function("page.live.value('guided') === 1")
    assert "guided=true" in live.evaluate(LINK)
