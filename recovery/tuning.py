"""Tuning constants of clustering and growth: what each limits or weighs, and its basis.

Ranks and breadths are counted in steps: the more, the more an edit accepts besides the failing
line. A step costs an edit half a per cent of its worth (`BREADTH_FACTOR`). What a value rests on is
said in one of these ways:

- *bound*: it keeps time or memory within limits, and is out of reach of ordinary source;
- *revised*: the earlier values are given; by what they were compared has not been kept;
- *measured*: the survey of the public corpus under preliminary.g4, with about half of the value: so
  many clusters instead of the 53 that it had then; or 53 with *other proposals*; or *the same*
  clusters and proposals. It is not known whether the changed proposals are better or worse;
- *not measured*: a first guess that has not been compared with another value.

Whoever changes a value compares `krl bench mutation` before and after, for growing
`krl recover --auto --hold-out`, and says here what came of it.
"""

# ---------------------------------------------------------- which lines are searched for edits

#: Tokens of a failing line beyond which no edit is sought. Bound: no line written by hand is as
#: long.
LONGEST_LINE = 1_000
#: Frames on the stacks that a line begins with, beyond which no edit is sought. Revised: 16, 5. A
#: block adds two or three frames, the deepest failing line of our own programs has 15; with
#: hundreds a search takes minutes, for the line is read anew at each trial.
DEEPEST_STACK = 150

# ------------------------------------------------------------------- words that a line means
# `recovery.survey.suspected_keywords`: when a name on failing lines may be meant as a keyword.
# Measured: with the rules of `recovery.induction.inferred_keywords` fewer of the words are wrong (2
# of 39 instead of 63 of 94, on the public corpus under preliminary.g4), but the survey has 57
# clusters instead of 53, and of 48 mutants (seed 778) 32 are repaired first instead of 34.

#: Files in which a name has to stand where no name can. Not measured.
SUSPECTED_FILES = 2
#: Different words on one side of it, so that it is no declared name beside its type. Measured: 56
#: clusters with 1.
SUSPECTED_NEIGHBOURS = 3
#: Uses with no operand on either side that count as much as neighbours. Measured: 54 clusters with
#: 3.
SUSPECTED_ALONE = 6
#: Different names that may come in a place for it to be a place of keywords. Measured: the same
#: with 1.
SUSPECTED_CHOICE = 2
#: The least share of its uses on failing lines where it stands so. Revised: 0.02.
SUSPECTED_SHARE = 0.8

# -------------------------------------------------------------------- the profile of a grammar
# `recovery.proposals.grammar_profile`, `collocations`, `similarity`, `recovery.forms.keywords`.

#: Alternatives from which on a rule gathers kinds of statement, operand or the like. Not measured.
HUB_ALTERNATIVES = 4
#: Steps in breadth for twice as many rules that lead to a rule. Measured: 56 clusters with 2.
WIDTH_PER_DOUBLING = 5
#: Steps that are saved where a text is written as elsewhere in the grammar. Measured: other
#: proposals with 3.
SAME_TEXT_BONUS = 6
#: A rule that has more than one in so many of all reserved words lists them. Measured: the same
#: with 2.
WORD_LIST_PART = 4
#: A rule of words and names that has more than one in so many of all reserved words lists no types.
#: Not measured.
TYPE_LIST_PART = 2
#: A symbol is usual where it has at least one in so many of the places of a kind. Measured: other
#: proposals with 1.
USUAL_PART = 3
#: How like an alternative has to be to one of a rule, as a ratio of `difflib`. Measured: 54
#: clusters with 0.2.
SIMILAR_RATIO = 0.6
#: Steps for an alternative like those that a rule has, and against one unlike them; where more
#: speaks for it that it is; and where hardly anything else can be meant. Measured:
#: `SIMILARITY_STEPS` other proposals with 3, `STRONG_SIMILARITY_STEPS` 54 clusters with 6. Else not
#: measured.
SIMILARITY_STEPS = 6
STRONG_SIMILARITY_STEPS = 12
STRONGEST_SIMILARITY_STEPS = 18
#: Steps against a longer alternative of a rule that gathers single rules. Measured: other proposals
#: with 1.
LOOSE_GATHERING_COST = 2
#: Steps against an alternative of a new form, and alternatives from which on a rule has forms
#: enough for nothing more to speak against another one. Measured: other proposals with 1, 56
#: clusters with 3.
NEW_FORM_COST = 2
MANY_FORMS = 6

# --------------------------------------------------------------------------- phrases of an edit
# `recovery.proposals.segmentation`, `phrases`, `alignment`, `recovery.forms.rule_matcher`.

#: Tokens of a line that is cut into operands. Bound: the cost grows with the cube.
LONGEST_SEGMENTED = 120
#: Costs of a cut: a single token, an operand of several, and each seam at which an operand could be
#: cut further. A seam costs more than writing its parts out. Measured: the same with 5, the same
#: with 4, 55 clusters with 15.
TOKEN_COST = 10
OPERAND_COST = 9
SEAM_COST = 30
#: Answers about segments and rules, and about lines under edits, that are kept. Bound on memory.
MOST_ANSWERS_KEPT = 200_000
#: Alignments, and lines with their sites, that are kept. Bound on memory.
MOST_ALIGNMENTS_KEPT = 2_000
#: Tokens of a beginning from which longer ones are read on. Bound on memory.
LONGEST_BEGINNING_KEPT = 24
#: Rules tried for an operand that stands alone, those that nothing calls and the most used ones.
#: Measured: other proposals with 3; without it two of 40 mutants (seed 55) have rank 4 or 5, not 1.
MOST_OPERAND_RULES = 6
#: Rules tried that the edited rule refers to already. Measured: 54 clusters with 1.
MOST_NEAR_RULES = 2
#: Steps that a rule costs at most where it usually stands, and more where it is narrower than what
#: usually does. Measured: other proposals with 1, the same with 2.
USUAL_RULE_COST = 2
NARROWER_RULE_COST = 5
#: Steps of a rule that repeats a part: `variable`, beside a name with an index. Not measured.
REPEATED_COST = 2
#: Phrases that are aligned, the longest first, and columns they may give. Bound: cost grows with
#: the product.
MOST_ALIGNED = 16
MOST_COLUMNS = 14
#: Rules that a column of operands may have as a choice. Measured: other proposals with 1.
MOST_CHOICES = 3
#: Combinations of columns for lines that have little but their first word in common. Not measured.
MOST_LINE_SHAPES = 6
#: How general operands are written: from the narrowest rule on, so many. Measured: 51 clusters with
#: 1.
PHRASE_LEVELS = 3

# -------------------------------------------------------------------------------- sites of edits
# `recovery.proposals.site_finder` and `*_sites` beside it, `line_reading`.

#: Steps of any edit at a site. It only counts beside edits of blocks, which have none. Measured:
#: other proposals with 4.
SITE_COST = 8
#: Steps of an alternative to an element in the middle of a sequence, and to its first one where
#: that is the word that says what a line is. Measured: `WIDEN_FIRST_WORD_COST` 55 clusters with 11.
#: Else not measured.
WIDEN_COST = 12
WIDEN_FIRST_WORD_COST = 22
#: Steps of what is hardly ever meant. Measured: other proposals with 4.
UNLIKELY_COST = 8
#: Steps of the operand before a site repeated behind a sign, and the part of the operand's own
#: breadth that counts. Measured: other proposals with 2, other proposals with 1.
REPETITION_COST = 4
REPETITION_BREADTH_PART = 3
#: Elements that an edit leaves out, tokens that it inserts ahead of a failure. Measured: 54
#: clusters with 1.
MOST_SKIPPED = 3
#: Tokens after the failure at which the grammar may continue. Bound.
LONGEST_RUN = 24
#: Places at which the rest of the line can be read, the nearest ones. Measured: the same with 1.
MOST_RESUMPTIONS = 3
#: Tokens in front of a rule that leave it the same construct. Measured: other proposals with 1.
LONGEST_PREFIX = 3
#: Elements of a sequence in which one first word may stand for another. Measured: the same with 2.
SHARED_ELEMENTS = 4

# ----------------------------------------------------------------------------- order of candidates
# `recovery.proposals.candidates`, `edit_writer`, `block_inference`.

#: What is left of an edit's worth for each step in breadth: of two that mend nearly as much, the
#: more restrictive is preferred. Measured: 58 clusters with 0.99.
BREADTH_FACTOR = 0.995
#: What each further edit of the same rule has left, so that other rules are tried. Measured: other
#: proposals with 0.86.
SAME_RULE_FACTOR = 0.93
#: Steps for a line with a word of its own and lines behind it: a part of a block. Measured: other
#: proposals with 2.
BLOCK_PART_BONUS = 4
#: Steps of a block as an alternative of what is no rule of lines. Not measured.
NO_LINE_RULE_COST = 12
#: Forms of a block's first and last line, and bodies, that are combined. Measured: other proposals
#: with 1, the same with 2.
MOST_BLOCK_FORMS = 3
MOST_BODIES = 4

# ------------------------------------------------------------------------- search for a cause
# `recovery.clustering.causes`, `search`. *Light* is for groups behind the heaviest.

#: Groups searched with the full limits. Revised: 30.
HEAVY_GROUPS = 12
#: Causes sought in a group, one after the other; the rest of its lines stay together. Measured: the
#: same with 2.
CAUSES_PER_GROUP = 4
#: Lines of a group whose candidates are tried. Measured: 52 clusters with 1.
SPECIMENS = 3
#: Further lines of a group, and of those that fail or begin alike, whose sites are compared.
#: Measured: 57 clusters with 3.
VARIED_LINES = 6
#: Candidates tried on a sample of lines. Revised: 90, 80, 140, 120; light 40, 60, 50.
MOST_TRIED = 105
MOST_TRIED_LIGHT = 48
#: One trial in so many is for wider candidates. Measured: 69 clusters with 1.
WIDE_PART = 3
#: Candidates tried of a site before any other, and wider ones where these do most. Measured: 48
#: clusters with 1, 50 clusters with 2.
NARROW_PER_SITE = 2
WIDE_PER_SITE = 4
#: Lines of a group, and of those that fail alike, in a sample. Revised: 24, 12.
SAMPLE_LINES = 8
#: Candidates with the same result that are considered, the narrowest. Revised: 4.
KEPT_PER_RESULT = 12
#: Candidates tried on all lines, and those of one kind of edit in one rule. Revised: 6, 5, 8.
KEPT = 10
KEPT_LIGHT = 6
KEPT_PER_RULE = 3
#: Candidates tried on the negatives. Revised: 30, 15, 24, 40; light 10, 15.
MOST_SCORED = 24
MOST_SCORED_LIGHT = 12
#: Proposals shown of a cause: what a person looks through.
MOST_PROPOSALS = 5

# ------------------------------------------------------------------------- worth of a proposal
# `recovery.clustering.worth`, `order`, `search`.

#: Weight of a mended line of another group than the one a cause is sought for. Measured: 58
#: clusters with 0.15.
OTHER_GROUP_WEIGHT = 0.3
#: Weight of a line that is read further and still fails. Measured: 54 clusters with 0.125.
ADVANCED_WEIGHT = 0.25
#: Weight of the lines themselves where nothing behind them in their files can be read. Measured:
#: other proposals with 0.1.
LINE_WEIGHT = 0.2
#: For mending every line that fails at the same token: none is left to explain. Measured: without
#: it the public corpus gets SWITCH with a variable instead of an expression.
ALL_ALIKE_FACTOR = 1.25
#: For reading as a name what all lines have as a keyword, and for reserving what most lack.
#: Measured: 58 clusters with 0.2 for the first alone.
OTHER_WORDS_FACTOR = 0.6
#: For reserving a word that is a name in files that parse, and for giving some of its lines two
#: readings. Revised: 0.97 for the second.
FLAW_FACTOR = 0.5
#: The part of the width of the rule of names that an edit pays to leave its words names. Measured:
#: the same with 1.
STILL_NAMES_PART = 2

# ---------------------------------------------------------------------------------- trials
# `recovery.clustering.edit_trial`, `joint_trial`, `file_trial`, `regression`, `negative_score`.

#: Recognisers of edited grammars that are kept, and their configurations together. Bound on memory.
MOST_RECOGNIZERS_KEPT = 160
MOST_CONFIGURATIONS_KEPT = 40_000
#: New objects after which garbage is collected while causes are sought. Bound on memory, some 200
#: MB. Revised: 500,000; most of these collections found less than 2,000 objects, in half a second.
MANY_OBJECTS = 2_000_000
#: Configurations of one state under an edited grammar; an edit that needs more gives lines
#: exponentially many readings and is no good one. Bound: without it one edit could use up the
#: memory.
MOST_CONFIGURATIONS_TRIED = 2_000
#: States in which one line is read under an edit, for the same reason. Bound: of 600,000 lines read
#: under edits of the restrictive start none needed more than 281.
MOST_STATES = 2_000
#: Mended lines that are looked at for a second reading, the shortest. Not measured.
LINES_READ_TWICE = 4
#: Files tried for a line, the shortest, and for a group, and their tokens. Bound on time.
FILES_PER_LINE = 4
MOST_FILES = 12
MOST_FILE_TOKENS = 6_000
#: Files read again for what a mended line entails, and their characters together. Bound on time.
MOST_REREAD = 40
MOST_REREAD_TEXT = 200_000
#: Cores of an edited grammar's automaton beyond which no further file is read under it: an edit
#: that gives every line a second reading makes new ones in each file. Bound on time and memory.
MOST_CORES = 2_000
#: Files that parse in which a newly reserved word is tried, the shortest, and characters searched
#: for such words. Bound on time.
FILES_PER_WORD = 6
MOST_SEARCHED_TEXT = 4_000_000
#: Generated negatives on which candidates are tried, and their seed: enough to tell edits apart,
#: few enough to be read for every candidate that is kept. Not measured.
GENERATED_NEGATIVES = 250
NEGATIVES_SEED = 1

# -------------------------------------------------------------------------------- joining causes
# `recovery.clustering.joined_causes`, `edit_merging`, `completion`, `title`.

#: Causes that a later one is compared with: the first ones hold back most. Bound on time.
MOST_COMPARED = 40
#: Symbols that make an alternative a form of its own, whatever word it begins with. Measured: other
#: proposals with 2.
FORM_SYMBOLS = 4
#: Edits that a merged cause may have: a person has to see at a glance that they are one. Measured:
#: 54 clusters with 1.
MOST_MERGED_EDITS = 3
#: Proposals of a cause that are made in further places, places of each, and the least share of its
#: lines that they leave for that. Not measured.
MOST_EXTENDED = 2
MOST_PLACES = 6
LEAST_LEFT = 0.05
#: Causes up to which they are completed: where there are more, lines fail for several, and more
#: edits would mix them; proposals of each, in different rules; how often what one leaves is sought;
#: and groups of lines that are searched each time. Bound on time.
MOST_CAUSES_COMPLETED = 5
MOST_COMPLETED = 2
MOST_COMPLETIONS = 8
MOST_GROUPS_COMPLETED = 4
#: The least share of its lines that a proposal repairs to be completed, and that it has to repair
#: then. Not measured: the second keeps causes apart where lines fail for several.
LEAST_COMPLETED = 0.1
NEARLY_ALL = 0.9
#: Tokens that could have come which a title names: more say nothing to a reader. Measured: other
#: proposals with 1.
MOST_EXPECTED = 2
#: Words and signs of a line in a title, where another cluster has the same. Measured: the same with
#: 4.
MOST_DISTINCT = 8
#: Reserved words that a title lists, where several stand for names. Measured: the same with 1.
MOST_LISTED = 3

#: Examples in the record of a cluster besides the first. Bound: a page shows them all.
MOST_EXAMPLES = 5

# ----------------------------------------------------------------------------- growing a grammar
# `recovery.induction`, `recovery.forms`, `recovery.survey.unreserved_keywords`.

#: So many are no coincidence: lines with a word, words that are followed alike, texts that begin
#: alike, origins against one. Not measured.
SEVERAL = 3
#: Origins, where there are several, and files that have to show a keyword; origins that have to
#: show what is new between the brackets of operands. Measured: with the second origin for brackets
#: a split whose own sentences were rejected by 24 % comes to 7 %.
SEVERAL_ORIGINS = 2
SEVERAL_FILES = 3

#: Different words up to which a context is one of keywords; where names may be too, fewer. Not
#: measured.
FEW_WORDS = 8
FEWER_WORDS = 3
#: Files that it needs in a single origin, where there are others; and what else recurs in a
#: single origin. Not measured.
INFERRED_FILES_ALONE = 5
LEAST_FILES_ALONE = 2
#: The least share of its uses in such contexts, and of lines that have a quote in pairs; the share
#: of files with uses as a name from which on it stays a name. Not measured.
INFERRED_SHARE = 0.8
NAME_SHARE = 0.02
#: The least share of lines with a word ahead that others begin without it, by so many tokens. Not
#: measured.
PREFIX_SHARE = 0.6
PREFIX_TOKENS = 5
#: Places that are remembered of a line, and given as evidence. Bound: for a reader.
PLACES_REMEMBERED = 3
PLACES_SHOWN = 10
#: Places of a single file that an edit without a new word needs. Not measured.
PLACES_IN_ONE_FILE = 2
#: The least share of files in which a pair of words is in balance (damaged files are the others),
#: their least number, and that of their origins. Revised: 0.95, less than what a corpus has with
#: every tenth file cut.
BALANCED_SHARE = 0.85
BALANCED_FILES = 3
BALANCED_ORIGINS = 2
#: The share of files that may be damaged: while more fail, a single line shows what is missing. Of
#: the public files 2 % are. Not measured.
DAMAGED_SHARE = 0.05
#: Among so many files one may be damaged. Not measured.
FILES_WITH_ONE_DAMAGED = 6
#: Words between opener and closer of one block. Not measured.
BLOCK_MIDDLES = 3
#: A middle is in at least one in so many blocks, or in blocks of so many origins; where more than
#: one in so many of the lines that blocks begin with are no middle, they have a body ahead of it.
#: Not measured.
MIDDLE_PART = 3
MIDDLE_ORIGINS = 3
BODY_PART = 20
#: The part of what one rule reads that two may read together to be preferred. Not measured.
READ_TOGETHER_SHARE = 0.8
#: Different signs and blanks in quotes from which on any character may be there. Not measured.
QUOTED_SIGNS = 2
#: How unlikely it is that digits would be missing by chance. Not measured.
UNLIKELY = 0.01
#: Kinds of list from which on a first item may have a form of its own. Not measured.
MANY_LISTS = 8
#: Characters of the signs ahead that distinguish one in a line from others. Bound on memory.
LONGEST_SIGNS_AHEAD = 60
#: Lines of a form that a rule is tried on. Bound on time.
MOST_SAMPLES = 64
#: Lists of more than one item from which on none is taken to be long where none is, and the items
#: behind the first one up to which a list is short. Where long lists are usual a seventh or more of
#: those with two items have a fourth. Revised: 50, then 20; corpora of 16 and 45 such indices left
#: them unbounded, and some 100 of 1,000 sentences were rejected for that.
SHORT_LIST_EXAMPLES = 12
ITEMS_BEHIND_THE_FIRST = 2
#: Elements in a row that may be missing together. Not measured.
MISSING_RUN = 3
#: Alternatives from which on a rule of words is the list of all of them. Not measured.
WORD_LIST_ALTERNATIVES = 8
#: What a level counts by which operators bind weaker than they need, in symbols, and by how many a
#: grammar may become longer where what holds in one place holds in another too. Not measured.
RULE_SYMBOLS = 12
#: The share of negatives that a grammar may accept when it is opened to what no file shows, a
#: little less than 1 % as so many tell it roughly; their number and their seed. Bound.
ACCEPTED_SHARE = 0.009
DRAWN_NEGATIVES = 3_000
DRAWN_SEED = 23
#: Files with lines that an edit mends, for one program more that it accepts and should not.
#: Revised: 100. A corpus of fewer files shows less: between these numbers it needs as many less.
GAIN_PER_NEGATIVE = 75
FEW_FILES = 20
MANY_FILES = 225
#: What is left of a gain for each symbol that is written and each step in width of its rule, and
#: the symbols for which a part counts more that may come any number of times. Not measured.
SYMBOL_FACTOR = 0.997
UNBOUNDED_SYMBOLS = 3
#: What a line counts that is read further and still fails. Not measured.
ADVANCED_WORTH = 0.25
#: Files of a single origin that an edit of an operand's rule needs, as operands are everywhere.
#: Not measured.
OPERAND_FILES = 5
#: Grammars under which it is known how the files read: before steps, with all, with those kept.
#: Bound on memory.
GRAMMARS_KEPT = 3
#: Files, the shortest, on which a block is tried, and on which it is tried whether an alternative
#: is needed and what an edit does to damaged lines. Bound on time.
BLOCK_FILES = 12
FOLD_FILES = 40

# ---------------------------------------------------------------------------------- reproducers
# `recovery.reproducer`.

#: Items up to which every stretch and every pair is tried. Bound: the tests grow with the square.
EXHAUSTIVE_ITEMS = 40
#: Configurations before a line from which a program is made. Bound on time.
MOST_CONFIGURATIONS = 12
#: Tokens left out at a failure for the rest of the line to be read. Bound.
LONGEST_GAP = 64
#: Tokens read for one reproducer, about a second, and what a test costs besides. Revised:
#: 1,000,000.
MOST_TOKENS_READ = 3_000_000
TEST_COST = 40
#: Numbered names of each letter. Bound: more than any line has.
MOST_NAMES = 10_000
