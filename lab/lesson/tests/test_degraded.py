"""What a page still does without WebGL, with a graphics card that goes, and where its scripts may not run."""

import pytest

from .pages import SIZE, change, column, drawn, opened, window_of

NO_WEBGL = """const get = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind.startsWith('webgl') ? null : get.call(this, kind, ...more);
};"""


@pytest.mark.parametrize("kind", ["recorded", "live"])
def test_without_webgl_story_diagrams_and_values_go_on_and_the_scene_says_why_it_is_empty(browser, request, kind):
    window = window_of(browser, viewport=SIZE)
    window.add_init_script(NO_WEBGL)
    with opened(window, request.getfixturevalue(f"{kind}_file"), faults=("WebGL context",)) as page:
        assert "no WebGL" in page.locator("#blind").inner_text() and page.locator("#trouble").is_hidden()
        page.evaluate("page.player.seek(1); page.draw()")
        assert float(page.locator(".plot .values").first.inner_text().split("\n")[0].replace("−", "-")) != 0
        if kind == "live":
            page.locator("#live [name=next]").click()
            assert page.locator("#steps").input_value() == "1"
            change(page, spin=3)
            assert column(page, "phi_dot")[0] == -3


LOST = """async () => {
  const lose = page.stage.renderer.getContext().getExtension('WEBGL_lose_context');
  const back = new Promise((done) => page.stage.canvas.addEventListener('webglcontextrestored', done, {once: true}));
  lose.loseContext();
  setTimeout(() => lose.restoreContext());
  await back;
  return new Promise((done) => setTimeout(() => done(page.draw() ?? page.stage.renderer.info.render.triangles)));
}"""


def test_after_a_lost_graphics_card_the_scene_is_drawn_again(browser, recorded_file):
    window = window_of(browser, viewport=SIZE)
    with opened(window, recorded_file, faults=("THREE.WebGLRenderer: Context",)) as page, drawn(page):
        before = page.evaluate("page.stage.renderer.info.render.triangles")
        assert page.evaluate(LOST) == before > 1000


@pytest.mark.parametrize("policy", ["script-src 'none'", "script-src 'unsafe-inline'", None])
def test_where_its_scripts_may_not_run_the_page_says_so(browser, recorded_file, policy):
    """Without any script, without the modules of the import map, and without JavaScript."""
    context = browser.new_context(java_script_enabled=policy is not None)
    page = context.new_page()
    headers = {"content-type": "text/html"} | ({"content-security-policy": policy} if policy else {})
    page.route("**/*", lambda route: route.fulfill(body=recorded_file.read_text(), headers=headers))
    page.goto("http://wheel.test/")
    page.wait_for_timeout(200)
    sentence = page.locator("#blocked")
    assert "JavaScript" in sentence.text_content() and "Content-Security-Policy" in sentence.text_content()
    context.close()


def test_where_they_run_the_sentence_is_gone(recorded):
    assert recorded.locator("#blocked").count() == 0
