"""Pages of runs in a browser without a screen: Debian's Chromium, by Selenium."""

import re
import time
from pathlib import Path

import html5lib
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

SOFTWARE_GL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_GL = ("--disable-gpu", "--disable-3d-apis")
DATA = re.compile(r'(<script type="application/json" id="data">)(.*?)(</script>)', re.S)


def start_browser(with_webgl=True, width=1200):
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", f"--window-size={width},900", *(SOFTWARE_GL if with_webgl else NO_GL)):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))


class Page:
    """A page that has been opened, once it has drawn itself."""

    def __init__(self, browser, file, limit=30):
        self.browser, self.file = browser, Path(file)
        browser.get_log("browser")  # what others have said
        browser.get(self.file.absolute().as_uri())
        end = time.monotonic() + limit
        while not self.run("return document.body.dataset.ready === 'yes'"):
            if time.monotonic() > end:
                raise AssertionError(f"{file} does not come to its end: {browser.get_log('browser')}")
            time.sleep(0.05)

    def run(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    @property
    def text(self):
        return self.run("return document.getElementById('page').innerText")

    @property
    def said(self):
        """What the browser had to say: errors, warnings."""
        return [entry["message"] for entry in self.browser.get_log("browser")]

    def click(self, selector, right, down):
        """Clicks an element at shares of its width and height, as a mouse does."""
        self.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self.run("""const element = document.querySelector(arguments[0]), frame = element.getBoundingClientRect();
                    const at = {clientX: frame.left + arguments[1] * frame.width, clientY: frame.top + arguments[2] * frame.height, bubbles: true};
                    for (const kind of ['pointerdown', 'pointerup', 'click']) element.dispatchEvent(new (kind === 'click' ? MouseEvent : PointerEvent)(kind, at));""",
                 selector, right, down)


def parse_strictly(file):
    """Raises where the file is no HTML5."""
    html5lib.HTMLParser(strict=True).parse(Path(file).read_text(encoding="utf-8"))


def with_data(file, change):
    """Replaces what the page shows by what `change` makes of the text of its data."""
    text = Path(file).read_text(encoding="utf-8")
    head, data, tail = DATA.search(text).groups()
    Path(file).write_text(DATA.sub(lambda _: head + change(data) + tail, text, count=1), encoding="utf-8")
