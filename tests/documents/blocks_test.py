#!/usr/bin/python3
"""No block of the pages is passed over silently."""

import unittest

from blocks import COMMANDS, SHOWN, blocks_of, pages

LOOKED_AT = ("cpp", "json", "python", COMMANDS)


class BlocksTest(unittest.TestCase):
    def test_every_block_is_looked_at_or_says_why_not(self):
        for page in pages():
            for block in blocks_of(page):
                with self.subTest(block=str(block), language=block.language):
                    if block.language not in LOOKED_AT + SHOWN:
                        self.assertIn("not run", block.notes)
                    self.assertNotEqual(block.notes.get("not run"), "")

    def test_every_fence_makes_a_block(self):
        for page in pages():
            fenced = [block for block in blocks_of(page) if block.language != COMMANDS]
            self.assertEqual(page.read_text().count("```"), 2 * len(fenced), page.name)


if __name__ == "__main__":
    unittest.main()
