"""What tests of pages ask a browser."""

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement

#: A function for scripts: whether anything is drawn on a canvas.
HAS_INK = """
const hasInk = (canvas) => canvas.getContext("2d")
  .getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value);
"""


def load(browser: webdriver.Chrome, address: str) -> None:
    """Load an address anew, also where nothing but the fragment differs."""
    browser.get("about:blank")
    browser.get(address)


def find_all(browser: webdriver.Chrome, selector: str) -> list[WebElement]:
    return browser.find_elements(By.CSS_SELECTOR, selector)


def find(browser: webdriver.Chrome, selector: str) -> WebElement:
    return browser.find_element(By.CSS_SELECTOR, selector)


def row_titles(browser: webdriver.Chrome) -> list[str]:
    """The titles of the rows that are shown."""
    titles = "[...document.querySelectorAll('.row:not([hidden]) .open')].map(e => e.textContent)"
    return list(browser.execute_script(f"return {titles}"))
