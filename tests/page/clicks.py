"""Opens a page of `bidir cost` in headless Chromium, uses its controls, and looks for errors: clicks.py REPORT/index.html [PICTURE.png]

Needs Chromium with its driver, and Python's selenium.
"""

import base64
import pathlib
import shutil
import sys

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

options = webdriver.ChromeOptions()
for argument in ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage"]:
    options.add_argument(argument)
options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))


def holds(condition, words):
    if not condition:
        sys.exit(f"clicks.py: {words}")


def settle():
    browser.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))")


def quiet(where):
    # Reading a picture's pixels back, as this test does, draws a warning of its own.
    log = [entry for entry in browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING") and "willReadFrequently" not in entry["message"]]
    holds(not log, f"{where}: the console says {log}")
    wide, window = browser.execute_script("return [document.documentElement.scrollWidth, document.documentElement.clientWidth]")
    holds(wide <= window, f"{where}: the page is {wide} wide in a window of {window}")


def open_page(file, width, dark):
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": [scheme]})
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.get(file.as_uri())
    settle()
    quiet(f"opened at {width}")


def toggles():
    labels = browser.find_elements(By.CSS_SELECTOR, "fieldset label")
    holds(len(labels) >= 6, "there is hardly anything to choose")
    for label in labels[::-1]:
        browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", label)
        ActionChains(browser).move_to_element(label).click().perform()
        settle()
        holds(label.find_element(By.TAG_NAME, "input").is_selected(), f"a click on {label.text} does not choose it")
        quiet(label.text)


def shown(index):
    """What a pane of the viewer shows, as one number of its pixels."""
    script = """const c = document.querySelectorAll('.panes canvas')[arguments[0]];
        return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((sum, v, i) => (sum * 31 + v * (i % 251)) % 1000003, 7)"""
    return browser.execute_script(script, index)


def viewer():
    canvas = browser.find_elements(By.CSS_SELECTOR, ".panes canvas")[0]
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'}); arguments[0].focus({preventScroll: true})", canvas)
    before = [shown(0), shown(1)]
    holds(before[0] != before[1], "both panes show the same")
    ActionChains(browser).send_keys("+").send_keys("+").send_keys(Keys.ARROW_RIGHT).perform()
    settle()
    holds(shown(0) != before[0] and shown(1) != before[1], "the panes do not move together")
    ActionChains(browser).send_keys("0").perform()
    settle()
    holds([shown(0), shown(1)] == before, "the panes do not come back")
    slider = browser.find_element(By.CSS_SELECTOR, "input[aria-label='Exposure']")
    browser.execute_script("arguments[0].value = 2; arguments[0].dispatchEvent(new Event('input', {bubbles: true}))", slider)
    settle()
    holds(shown(0) != before[0], "exposure changes nothing")
    quiet("viewer")


def series():
    drawn = browser.find_elements(By.CSS_SELECTOR, "[data-part=error] svg[role=group] .series")
    holds(len(drawn) == 4, f"{len(drawn)} curves of four")


def picture(path):
    height = browser.execute_script("return document.documentElement.scrollHeight")
    clip = {"x": 0, "y": 0, "width": 1200, "height": height, "scale": 1}
    shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
    pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))


page = pathlib.Path(sys.argv[1]).resolve()
open_page(page, 1200, False)
if len(sys.argv) > 2:
    picture(sys.argv[2])
series()
viewer()
open_page(page, 1200, False)
toggles()
open_page(page, 1200, True)
open_page(page, 360, True)
open_page(page, 360, False)
toggles()
browser.quit()
print("no error")
