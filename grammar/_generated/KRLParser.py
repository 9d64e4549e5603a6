# Generated from KRL.g4 by ANTLR 4.13.2
# encoding: utf-8
from antlr4 import *
from io import StringIO
import sys
if sys.version_info[1] > 5:
	from typing import TextIO
else:
	from typing.io import TextIO

def serializedATN():
    return [
        4,1,78,473,2,0,7,0,2,1,7,1,2,2,7,2,2,3,7,3,2,4,7,4,2,5,7,5,2,6,7,
        6,2,7,7,7,2,8,7,8,2,9,7,9,2,10,7,10,2,11,7,11,2,12,7,12,2,13,7,13,
        2,14,7,14,2,15,7,15,2,16,7,16,2,17,7,17,2,18,7,18,2,19,7,19,2,20,
        7,20,2,21,7,21,2,22,7,22,2,23,7,23,2,24,7,24,2,25,7,25,2,26,7,26,
        2,27,7,27,2,28,7,28,2,29,7,29,2,30,7,30,2,31,7,31,2,32,7,32,2,33,
        7,33,2,34,7,34,2,35,7,35,2,36,7,36,2,37,7,37,2,38,7,38,2,39,7,39,
        2,40,7,40,2,41,7,41,2,42,7,42,2,43,7,43,1,0,5,0,90,8,0,10,0,12,0,
        93,9,0,1,0,1,0,5,0,97,8,0,10,0,12,0,100,9,0,1,0,1,0,3,0,104,8,0,
        1,0,5,0,107,8,0,10,0,12,0,110,9,0,1,0,1,0,1,1,1,1,1,1,1,1,5,1,118,
        8,1,10,1,12,1,121,9,1,1,2,1,2,1,2,1,2,1,2,1,2,5,2,129,8,2,10,2,12,
        2,132,9,2,1,2,5,2,135,8,2,10,2,12,2,138,9,2,1,2,1,2,1,3,1,3,1,3,
        1,3,5,3,146,8,3,10,3,12,3,149,9,3,1,3,1,3,1,4,4,4,154,8,4,11,4,12,
        4,155,1,5,1,5,1,5,1,5,1,5,1,6,1,6,1,6,1,6,1,6,1,6,1,6,1,7,1,7,1,
        8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,8,1,
        8,1,8,3,8,190,8,8,1,9,1,9,1,9,1,9,1,9,1,9,1,9,1,9,1,9,1,9,1,9,1,
        9,3,9,204,8,9,1,10,1,10,1,10,1,10,3,10,210,8,10,1,11,1,11,1,11,3,
        11,215,8,11,1,11,1,11,1,12,1,12,1,12,5,12,222,8,12,10,12,12,12,225,
        9,12,1,13,1,13,1,13,1,13,1,13,5,13,232,8,13,10,13,12,13,235,9,13,
        1,13,1,13,1,13,5,13,240,8,13,10,13,12,13,243,9,13,3,13,245,8,13,
        1,13,1,13,1,14,1,14,1,14,1,14,1,14,1,14,1,14,1,14,5,14,257,8,14,
        10,14,12,14,260,9,14,1,14,1,14,1,15,1,15,1,15,1,15,5,15,268,8,15,
        10,15,12,15,271,9,15,1,15,1,15,1,16,1,16,1,16,5,16,278,8,16,10,16,
        12,16,281,9,16,1,16,1,16,1,16,1,17,1,17,1,17,5,17,289,8,17,10,17,
        12,17,292,9,17,1,17,1,17,1,18,1,18,1,19,1,19,1,20,1,20,1,21,1,21,
        1,21,1,21,1,21,1,21,3,21,308,8,21,1,22,1,22,1,23,1,23,1,23,3,23,
        315,8,23,1,23,1,23,1,23,3,23,320,8,23,1,23,1,23,1,23,1,23,1,23,3,
        23,327,8,23,3,23,329,8,23,1,24,1,24,3,24,333,8,24,1,25,1,25,1,25,
        1,25,1,25,1,25,1,25,1,25,1,25,1,25,1,25,1,25,1,25,1,25,3,25,349,
        8,25,1,26,1,26,3,26,353,8,26,1,27,1,27,1,28,1,28,1,29,1,29,1,29,
        1,29,1,29,1,29,1,29,1,29,1,29,1,29,1,29,1,30,1,30,3,30,372,8,30,
        1,31,1,31,1,31,1,31,3,31,378,8,31,1,32,1,32,1,33,1,33,1,33,5,33,
        385,8,33,10,33,12,33,388,9,33,1,34,1,34,1,34,5,34,393,8,34,10,34,
        12,34,396,9,34,1,35,1,35,1,35,5,35,401,8,35,10,35,12,35,404,9,35,
        1,36,1,36,1,36,5,36,409,8,36,10,36,12,36,412,9,36,1,37,1,37,1,37,
        3,37,417,8,37,1,38,1,38,1,38,1,38,1,38,1,38,1,38,3,38,426,8,38,1,
        39,1,39,3,39,430,8,39,1,39,1,39,1,39,3,39,435,8,39,5,39,437,8,39,
        10,39,12,39,440,9,39,1,40,1,40,1,40,1,40,1,41,3,41,447,8,41,1,41,
        1,41,1,41,1,41,1,41,1,41,3,41,455,8,41,1,42,1,42,1,42,1,42,1,42,
        1,42,5,42,463,8,42,10,42,12,42,466,9,42,1,42,1,42,1,43,1,43,1,43,
        1,43,0,0,44,0,2,4,6,8,10,12,14,16,18,20,22,24,26,28,30,32,34,36,
        38,40,42,44,46,48,50,52,54,56,58,60,62,64,66,68,70,72,74,76,78,80,
        82,84,86,0,5,5,0,2,2,6,6,27,27,36,36,69,69,1,0,49,54,1,0,56,57,1,
        0,58,59,1,0,71,72,493,0,91,1,0,0,0,2,113,1,0,0,0,4,122,1,0,0,0,6,
        141,1,0,0,0,8,153,1,0,0,0,10,157,1,0,0,0,12,162,1,0,0,0,14,169,1,
        0,0,0,16,189,1,0,0,0,18,203,1,0,0,0,20,205,1,0,0,0,22,211,1,0,0,
        0,24,218,1,0,0,0,26,226,1,0,0,0,28,248,1,0,0,0,30,263,1,0,0,0,32,
        274,1,0,0,0,34,285,1,0,0,0,36,295,1,0,0,0,38,297,1,0,0,0,40,299,
        1,0,0,0,42,307,1,0,0,0,44,309,1,0,0,0,46,328,1,0,0,0,48,332,1,0,
        0,0,50,348,1,0,0,0,52,352,1,0,0,0,54,354,1,0,0,0,56,356,1,0,0,0,
        58,358,1,0,0,0,60,371,1,0,0,0,62,373,1,0,0,0,64,379,1,0,0,0,66,381,
        1,0,0,0,68,389,1,0,0,0,70,397,1,0,0,0,72,405,1,0,0,0,74,416,1,0,
        0,0,76,425,1,0,0,0,78,427,1,0,0,0,80,441,1,0,0,0,82,454,1,0,0,0,
        84,456,1,0,0,0,86,469,1,0,0,0,88,90,5,76,0,0,89,88,1,0,0,0,90,93,
        1,0,0,0,91,89,1,0,0,0,91,92,1,0,0,0,92,98,1,0,0,0,93,91,1,0,0,0,
        94,95,5,75,0,0,95,97,3,8,4,0,96,94,1,0,0,0,97,100,1,0,0,0,98,96,
        1,0,0,0,98,99,1,0,0,0,99,103,1,0,0,0,100,98,1,0,0,0,101,104,3,2,
        1,0,102,104,3,6,3,0,103,101,1,0,0,0,103,102,1,0,0,0,104,108,1,0,
        0,0,105,107,5,76,0,0,106,105,1,0,0,0,107,110,1,0,0,0,108,106,1,0,
        0,0,108,109,1,0,0,0,109,111,1,0,0,0,110,108,1,0,0,0,111,112,5,0,
        0,1,112,1,1,0,0,0,113,119,3,4,2,0,114,115,3,8,4,0,115,116,3,4,2,
        0,116,118,1,0,0,0,117,114,1,0,0,0,118,121,1,0,0,0,119,117,1,0,0,
        0,119,120,1,0,0,0,120,3,1,0,0,0,121,119,1,0,0,0,122,123,5,10,0,0,
        123,124,5,69,0,0,124,125,5,60,0,0,125,126,5,61,0,0,126,130,3,8,4,
        0,127,129,3,10,5,0,128,127,1,0,0,0,129,132,1,0,0,0,130,128,1,0,0,
        0,130,131,1,0,0,0,131,136,1,0,0,0,132,130,1,0,0,0,133,135,3,16,8,
        0,134,133,1,0,0,0,135,138,1,0,0,0,136,134,1,0,0,0,136,137,1,0,0,
        0,137,139,1,0,0,0,138,136,1,0,0,0,139,140,5,16,0,0,140,5,1,0,0,0,
        141,142,5,11,0,0,142,143,5,69,0,0,143,147,3,8,4,0,144,146,3,12,6,
        0,145,144,1,0,0,0,146,149,1,0,0,0,147,145,1,0,0,0,147,148,1,0,0,
        0,148,150,1,0,0,0,149,147,1,0,0,0,150,151,5,17,0,0,151,7,1,0,0,0,
        152,154,5,76,0,0,153,152,1,0,0,0,154,155,1,0,0,0,155,153,1,0,0,0,
        155,156,1,0,0,0,156,9,1,0,0,0,157,158,5,9,0,0,158,159,3,14,7,0,159,
        160,5,69,0,0,160,161,3,8,4,0,161,11,1,0,0,0,162,163,5,9,0,0,163,
        164,3,14,7,0,164,165,5,69,0,0,165,166,5,55,0,0,166,167,3,82,41,0,
        167,168,3,8,4,0,168,13,1,0,0,0,169,170,7,0,0,0,170,15,1,0,0,0,171,
        172,3,18,9,0,172,173,3,8,4,0,173,190,1,0,0,0,174,175,3,26,13,0,175,
        176,3,8,4,0,176,190,1,0,0,0,177,178,3,28,14,0,178,179,3,8,4,0,179,
        190,1,0,0,0,180,181,3,30,15,0,181,182,3,8,4,0,182,190,1,0,0,0,183,
        184,3,32,16,0,184,185,3,8,4,0,185,190,1,0,0,0,186,187,3,34,17,0,
        187,188,3,8,4,0,188,190,1,0,0,0,189,171,1,0,0,0,189,174,1,0,0,0,
        189,177,1,0,0,0,189,180,1,0,0,0,189,183,1,0,0,0,189,186,1,0,0,0,
        190,17,1,0,0,0,191,204,3,20,10,0,192,204,3,22,11,0,193,204,3,46,
        23,0,194,204,3,50,25,0,195,204,3,58,29,0,196,204,3,42,21,0,197,204,
        3,54,27,0,198,204,3,36,18,0,199,204,3,38,19,0,200,204,3,40,20,0,
        201,204,3,56,28,0,202,204,3,44,22,0,203,191,1,0,0,0,203,192,1,0,
        0,0,203,193,1,0,0,0,203,194,1,0,0,0,203,195,1,0,0,0,203,196,1,0,
        0,0,203,197,1,0,0,0,203,198,1,0,0,0,203,199,1,0,0,0,203,200,1,0,
        0,0,203,201,1,0,0,0,203,202,1,0,0,0,204,19,1,0,0,0,205,206,3,78,
        39,0,206,209,5,55,0,0,207,210,3,62,31,0,208,210,3,84,42,0,209,207,
        1,0,0,0,209,208,1,0,0,0,210,21,1,0,0,0,211,212,5,69,0,0,212,214,
        5,60,0,0,213,215,3,24,12,0,214,213,1,0,0,0,214,215,1,0,0,0,215,216,
        1,0,0,0,216,217,5,61,0,0,217,23,1,0,0,0,218,223,3,62,31,0,219,220,
        5,66,0,0,220,222,3,62,31,0,221,219,1,0,0,0,222,225,1,0,0,0,223,221,
        1,0,0,0,223,224,1,0,0,0,224,25,1,0,0,0,225,223,1,0,0,0,226,227,5,
        26,0,0,227,228,3,62,31,0,228,229,5,41,0,0,229,233,3,8,4,0,230,232,
        3,16,8,0,231,230,1,0,0,0,232,235,1,0,0,0,233,231,1,0,0,0,233,234,
        1,0,0,0,234,244,1,0,0,0,235,233,1,0,0,0,236,237,5,15,0,0,237,241,
        3,8,4,0,238,240,3,16,8,0,239,238,1,0,0,0,240,243,1,0,0,0,241,239,
        1,0,0,0,241,242,1,0,0,0,242,245,1,0,0,0,243,241,1,0,0,0,244,236,
        1,0,0,0,244,245,1,0,0,0,245,246,1,0,0,0,246,247,5,19,0,0,247,27,
        1,0,0,0,248,249,5,24,0,0,249,250,5,69,0,0,250,251,5,55,0,0,251,252,
        3,62,31,0,252,253,5,42,0,0,253,254,3,62,31,0,254,258,3,8,4,0,255,
        257,3,16,8,0,256,255,1,0,0,0,257,260,1,0,0,0,258,256,1,0,0,0,258,
        259,1,0,0,0,259,261,1,0,0,0,260,258,1,0,0,0,261,262,5,18,0,0,262,
        29,1,0,0,0,263,264,5,48,0,0,264,265,3,62,31,0,265,269,3,8,4,0,266,
        268,3,16,8,0,267,266,1,0,0,0,268,271,1,0,0,0,269,267,1,0,0,0,269,
        270,1,0,0,0,270,272,1,0,0,0,271,269,1,0,0,0,272,273,5,21,0,0,273,
        31,1,0,0,0,274,275,5,37,0,0,275,279,3,8,4,0,276,278,3,16,8,0,277,
        276,1,0,0,0,278,281,1,0,0,0,279,277,1,0,0,0,279,280,1,0,0,0,280,
        282,1,0,0,0,281,279,1,0,0,0,282,283,5,45,0,0,283,284,3,62,31,0,284,
        33,1,0,0,0,285,286,5,30,0,0,286,290,3,8,4,0,287,289,3,16,8,0,288,
        287,1,0,0,0,289,292,1,0,0,0,290,288,1,0,0,0,290,291,1,0,0,0,291,
        293,1,0,0,0,292,290,1,0,0,0,293,294,5,20,0,0,294,35,1,0,0,0,295,
        296,5,22,0,0,296,37,1,0,0,0,297,298,5,25,0,0,298,39,1,0,0,0,299,
        300,5,8,0,0,300,41,1,0,0,0,301,302,5,46,0,0,302,303,5,24,0,0,303,
        308,3,62,31,0,304,305,5,46,0,0,305,306,5,40,0,0,306,308,3,62,31,
        0,307,301,1,0,0,0,307,304,1,0,0,0,308,43,1,0,0,0,309,310,5,39,0,
        0,310,45,1,0,0,0,311,312,5,35,0,0,312,314,3,48,24,0,313,315,5,5,
        0,0,314,313,1,0,0,0,314,315,1,0,0,0,315,329,1,0,0,0,316,317,5,29,
        0,0,317,319,3,48,24,0,318,320,5,4,0,0,319,318,1,0,0,0,319,320,1,
        0,0,0,320,329,1,0,0,0,321,322,5,7,0,0,322,323,3,48,24,0,323,324,
        5,66,0,0,324,326,3,48,24,0,325,327,5,4,0,0,326,325,1,0,0,0,326,327,
        1,0,0,0,327,329,1,0,0,0,328,311,1,0,0,0,328,316,1,0,0,0,328,321,
        1,0,0,0,329,47,1,0,0,0,330,333,3,78,39,0,331,333,3,84,42,0,332,330,
        1,0,0,0,332,331,1,0,0,0,333,49,1,0,0,0,334,335,5,28,0,0,335,336,
        5,9,0,0,336,337,5,71,0,0,337,338,5,47,0,0,338,339,3,62,31,0,339,
        340,5,14,0,0,340,341,3,52,26,0,341,349,1,0,0,0,342,343,5,28,0,0,
        343,344,5,33,0,0,344,349,5,71,0,0,345,346,5,28,0,0,346,347,5,32,
        0,0,347,349,5,71,0,0,348,334,1,0,0,0,348,342,1,0,0,0,348,345,1,0,
        0,0,349,51,1,0,0,0,350,353,3,22,11,0,351,353,3,54,27,0,352,350,1,
        0,0,0,352,351,1,0,0,0,353,53,1,0,0,0,354,355,5,3,0,0,355,55,1,0,
        0,0,356,357,5,38,0,0,357,57,1,0,0,0,358,359,5,43,0,0,359,360,5,47,
        0,0,360,361,5,13,0,0,361,362,5,55,0,0,362,363,5,71,0,0,363,364,5,
        12,0,0,364,365,5,55,0,0,365,366,5,71,0,0,366,367,5,14,0,0,367,368,
        3,60,30,0,368,59,1,0,0,0,369,372,3,20,10,0,370,372,3,22,11,0,371,
        369,1,0,0,0,371,370,1,0,0,0,372,61,1,0,0,0,373,377,3,66,33,0,374,
        375,3,64,32,0,375,376,3,66,33,0,376,378,1,0,0,0,377,374,1,0,0,0,
        377,378,1,0,0,0,378,63,1,0,0,0,379,380,7,1,0,0,380,65,1,0,0,0,381,
        386,3,68,34,0,382,383,5,34,0,0,383,385,3,68,34,0,384,382,1,0,0,0,
        385,388,1,0,0,0,386,384,1,0,0,0,386,387,1,0,0,0,387,67,1,0,0,0,388,
        386,1,0,0,0,389,394,3,70,35,0,390,391,5,1,0,0,391,393,3,70,35,0,
        392,390,1,0,0,0,393,396,1,0,0,0,394,392,1,0,0,0,394,395,1,0,0,0,
        395,69,1,0,0,0,396,394,1,0,0,0,397,402,3,72,36,0,398,399,7,2,0,0,
        399,401,3,72,36,0,400,398,1,0,0,0,401,404,1,0,0,0,402,400,1,0,0,
        0,402,403,1,0,0,0,403,71,1,0,0,0,404,402,1,0,0,0,405,410,3,74,37,
        0,406,407,7,3,0,0,407,409,3,74,37,0,408,406,1,0,0,0,409,412,1,0,
        0,0,410,408,1,0,0,0,410,411,1,0,0,0,411,73,1,0,0,0,412,410,1,0,0,
        0,413,414,5,31,0,0,414,417,3,74,37,0,415,417,3,76,38,0,416,413,1,
        0,0,0,416,415,1,0,0,0,417,75,1,0,0,0,418,426,3,82,41,0,419,426,3,
        78,39,0,420,426,3,22,11,0,421,422,5,60,0,0,422,423,3,62,31,0,423,
        424,5,61,0,0,424,426,1,0,0,0,425,418,1,0,0,0,425,419,1,0,0,0,425,
        420,1,0,0,0,425,421,1,0,0,0,426,77,1,0,0,0,427,429,5,69,0,0,428,
        430,3,80,40,0,429,428,1,0,0,0,429,430,1,0,0,0,430,438,1,0,0,0,431,
        432,5,68,0,0,432,434,5,69,0,0,433,435,3,80,40,0,434,433,1,0,0,0,
        434,435,1,0,0,0,435,437,1,0,0,0,436,431,1,0,0,0,437,440,1,0,0,0,
        438,436,1,0,0,0,438,439,1,0,0,0,439,79,1,0,0,0,440,438,1,0,0,0,441,
        442,5,62,0,0,442,443,3,62,31,0,443,444,5,63,0,0,444,81,1,0,0,0,445,
        447,5,57,0,0,446,445,1,0,0,0,446,447,1,0,0,0,447,448,1,0,0,0,448,
        455,7,4,0,0,449,455,5,44,0,0,450,455,5,23,0,0,451,455,5,73,0,0,452,
        455,5,74,0,0,453,455,5,70,0,0,454,446,1,0,0,0,454,449,1,0,0,0,454,
        450,1,0,0,0,454,451,1,0,0,0,454,452,1,0,0,0,454,453,1,0,0,0,455,
        83,1,0,0,0,456,457,5,64,0,0,457,458,5,69,0,0,458,459,5,67,0,0,459,
        464,3,86,43,0,460,461,5,66,0,0,461,463,3,86,43,0,462,460,1,0,0,0,
        463,466,1,0,0,0,464,462,1,0,0,0,464,465,1,0,0,0,465,467,1,0,0,0,
        466,464,1,0,0,0,467,468,5,65,0,0,468,85,1,0,0,0,469,470,5,69,0,0,
        470,471,3,82,41,0,471,87,1,0,0,0,43,91,98,103,108,119,130,136,147,
        155,189,203,209,214,223,233,241,244,258,269,279,290,307,314,319,
        326,328,332,348,352,371,377,386,394,402,410,416,425,429,434,438,
        446,454,464
    ]

class KRLParser ( Parser ):

    grammarFileName = "KRL.g4"

    atn = ATNDeserializer().deserialize(serializedATN())

    decisionsToDFA = [ DFA(ds, i) for i, ds in enumerate(atn.decisionToState) ]

    sharedContextCache = PredictionContextCache()

    literalNames = [ "<INVALID>", "'AND'", "'BOOL'", "'BRAKE'", "'C_DIS'", 
                     "'C_PTP'", "'CHAR'", "'CIRC'", "'CONTINUE'", "'DECL'", 
                     "'DEF'", "'DEFDAT'", "'DELAY'", "'DISTANCE'", "'DO'", 
                     "'ELSE'", "'END'", "'ENDDAT'", "'ENDFOR'", "'ENDIF'", 
                     "'ENDLOOP'", "'ENDWHILE'", "'EXIT'", "'FALSE'", "'FOR'", 
                     "'HALT'", "'IF'", "'INT'", "'INTERRUPT'", "'LIN'", 
                     "'LOOP'", "'NOT'", "'OFF'", "'ON'", "'OR'", "'PTP'", 
                     "'REAL'", "'REPEAT'", "'RESUME'", "'RETURN'", "'SEC'", 
                     "'THEN'", "'TO'", "'TRIGGER'", "'TRUE'", "'UNTIL'", 
                     "'WAIT'", "'WHEN'", "'WHILE'", "'=='", "'<>'", "'<='", 
                     "'>='", "'<'", "'>'", "'='", "'+'", "'-'", "'*'", "'/'", 
                     "'('", "')'", "'['", "']'", "'{'", "'}'", "','", "':'", 
                     "'.'" ]

    symbolicNames = [ "<INVALID>", "AND", "BOOL", "BRAKE", "C_DIS", "C_PTP", 
                      "CHAR", "CIRC", "CONTINUE", "DECL", "DEF", "DEFDAT", 
                      "DELAY", "DISTANCE", "DO", "ELSE", "END", "ENDDAT", 
                      "ENDFOR", "ENDIF", "ENDLOOP", "ENDWHILE", "EXIT", 
                      "FALSE", "FOR", "HALT", "IF", "INT", "INTERRUPT", 
                      "LIN", "LOOP", "NOT", "OFF", "ON", "OR", "PTP", "REAL", 
                      "REPEAT", "RESUME", "RETURN", "SEC", "THEN", "TO", 
                      "TRIGGER", "TRUE", "UNTIL", "WAIT", "WHEN", "WHILE", 
                      "EQUALS", "NOT_EQUAL", "AT_MOST", "AT_LEAST", "LESS", 
                      "GREATER", "ASSIGN", "PLUS", "MINUS", "TIMES", "DIVIDE", 
                      "LPAREN", "RPAREN", "LBRACKET", "RBRACKET", "LBRACE", 
                      "RBRACE", "COMMA", "COLON", "DOT", "NAME", "ENUM_CONSTANT", 
                      "INTEGER", "REAL_NUMBER", "BIT_STRING", "STRING", 
                      "HEADER", "NEWLINE", "COMMENT", "SPACE" ]

    RULE_module = 0
    RULE_program = 1
    RULE_procedure = 2
    RULE_dataList = 3
    RULE_eol = 4
    RULE_declaration = 5
    RULE_initialisation = 6
    RULE_type = 7
    RULE_statement = 8
    RULE_simpleStatement = 9
    RULE_assignment = 10
    RULE_call = 11
    RULE_arguments = 12
    RULE_ifStatement = 13
    RULE_forStatement = 14
    RULE_whileStatement = 15
    RULE_repeatStatement = 16
    RULE_loopStatement = 17
    RULE_exit = 18
    RULE_halt = 19
    RULE_continue = 20
    RULE_wait = 21
    RULE_return = 22
    RULE_motion = 23
    RULE_target = 24
    RULE_interrupt = 25
    RULE_interruptAction = 26
    RULE_brake = 27
    RULE_resume = 28
    RULE_trigger = 29
    RULE_triggerAction = 30
    RULE_expression = 31
    RULE_relation = 32
    RULE_disjunction = 33
    RULE_conjunction = 34
    RULE_sum = 35
    RULE_product = 36
    RULE_factor = 37
    RULE_primary = 38
    RULE_variable = 39
    RULE_index = 40
    RULE_literal = 41
    RULE_aggregate = 42
    RULE_component = 43

    ruleNames =  [ "module", "program", "procedure", "dataList", "eol", 
                   "declaration", "initialisation", "type", "statement", 
                   "simpleStatement", "assignment", "call", "arguments", 
                   "ifStatement", "forStatement", "whileStatement", "repeatStatement", 
                   "loopStatement", "exit", "halt", "continue", "wait", 
                   "return", "motion", "target", "interrupt", "interruptAction", 
                   "brake", "resume", "trigger", "triggerAction", "expression", 
                   "relation", "disjunction", "conjunction", "sum", "product", 
                   "factor", "primary", "variable", "index", "literal", 
                   "aggregate", "component" ]

    EOF = Token.EOF
    AND=1
    BOOL=2
    BRAKE=3
    C_DIS=4
    C_PTP=5
    CHAR=6
    CIRC=7
    CONTINUE=8
    DECL=9
    DEF=10
    DEFDAT=11
    DELAY=12
    DISTANCE=13
    DO=14
    ELSE=15
    END=16
    ENDDAT=17
    ENDFOR=18
    ENDIF=19
    ENDLOOP=20
    ENDWHILE=21
    EXIT=22
    FALSE=23
    FOR=24
    HALT=25
    IF=26
    INT=27
    INTERRUPT=28
    LIN=29
    LOOP=30
    NOT=31
    OFF=32
    ON=33
    OR=34
    PTP=35
    REAL=36
    REPEAT=37
    RESUME=38
    RETURN=39
    SEC=40
    THEN=41
    TO=42
    TRIGGER=43
    TRUE=44
    UNTIL=45
    WAIT=46
    WHEN=47
    WHILE=48
    EQUALS=49
    NOT_EQUAL=50
    AT_MOST=51
    AT_LEAST=52
    LESS=53
    GREATER=54
    ASSIGN=55
    PLUS=56
    MINUS=57
    TIMES=58
    DIVIDE=59
    LPAREN=60
    RPAREN=61
    LBRACKET=62
    RBRACKET=63
    LBRACE=64
    RBRACE=65
    COMMA=66
    COLON=67
    DOT=68
    NAME=69
    ENUM_CONSTANT=70
    INTEGER=71
    REAL_NUMBER=72
    BIT_STRING=73
    STRING=74
    HEADER=75
    NEWLINE=76
    COMMENT=77
    SPACE=78

    def __init__(self, input:TokenStream, output:TextIO = sys.stdout):
        super().__init__(input, output)
        self.checkVersion("4.13.2")
        self._interp = ParserATNSimulator(self, self.atn, self.decisionsToDFA, self.sharedContextCache)
        self._predicates = None




    class ModuleContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def EOF(self):
            return self.getToken(KRLParser.EOF, 0)

        def program(self):
            return self.getTypedRuleContext(KRLParser.ProgramContext,0)


        def dataList(self):
            return self.getTypedRuleContext(KRLParser.DataListContext,0)


        def NEWLINE(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.NEWLINE)
            else:
                return self.getToken(KRLParser.NEWLINE, i)

        def HEADER(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.HEADER)
            else:
                return self.getToken(KRLParser.HEADER, i)

        def eol(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.EolContext)
            else:
                return self.getTypedRuleContext(KRLParser.EolContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_module




    def module(self):

        localctx = KRLParser.ModuleContext(self, self._ctx, self.state)
        self.enterRule(localctx, 0, self.RULE_module)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 91
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==76:
                self.state = 88
                self.match(KRLParser.NEWLINE)
                self.state = 93
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 98
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==75:
                self.state = 94
                self.match(KRLParser.HEADER)
                self.state = 95
                self.eol()
                self.state = 100
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 103
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [10]:
                self.state = 101
                self.program()
                pass
            elif token in [11]:
                self.state = 102
                self.dataList()
                pass
            else:
                raise NoViableAltException(self)

            self.state = 108
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==76:
                self.state = 105
                self.match(KRLParser.NEWLINE)
                self.state = 110
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 111
            self.match(KRLParser.EOF)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ProgramContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def procedure(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.ProcedureContext)
            else:
                return self.getTypedRuleContext(KRLParser.ProcedureContext,i)


        def eol(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.EolContext)
            else:
                return self.getTypedRuleContext(KRLParser.EolContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_program




    def program(self):

        localctx = KRLParser.ProgramContext(self, self._ctx, self.state)
        self.enterRule(localctx, 2, self.RULE_program)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 113
            self.procedure()
            self.state = 119
            self._errHandler.sync(self)
            _alt = self._interp.adaptivePredict(self._input,4,self._ctx)
            while _alt!=2 and _alt!=ATN.INVALID_ALT_NUMBER:
                if _alt==1:
                    self.state = 114
                    self.eol()
                    self.state = 115
                    self.procedure() 
                self.state = 121
                self._errHandler.sync(self)
                _alt = self._interp.adaptivePredict(self._input,4,self._ctx)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ProcedureContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def DEF(self):
            return self.getToken(KRLParser.DEF, 0)

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def LPAREN(self):
            return self.getToken(KRLParser.LPAREN, 0)

        def RPAREN(self):
            return self.getToken(KRLParser.RPAREN, 0)

        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def END(self):
            return self.getToken(KRLParser.END, 0)

        def declaration(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.DeclarationContext)
            else:
                return self.getTypedRuleContext(KRLParser.DeclarationContext,i)


        def statement(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.StatementContext)
            else:
                return self.getTypedRuleContext(KRLParser.StatementContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_procedure




    def procedure(self):

        localctx = KRLParser.ProcedureContext(self, self._ctx, self.state)
        self.enterRule(localctx, 4, self.RULE_procedure)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 122
            self.match(KRLParser.DEF)
            self.state = 123
            self.match(KRLParser.NAME)
            self.state = 124
            self.match(KRLParser.LPAREN)
            self.state = 125
            self.match(KRLParser.RPAREN)
            self.state = 126
            self.eol()
            self.state = 130
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==9:
                self.state = 127
                self.declaration()
                self.state = 132
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 136
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                self.state = 133
                self.statement()
                self.state = 138
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 139
            self.match(KRLParser.END)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class DataListContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def DEFDAT(self):
            return self.getToken(KRLParser.DEFDAT, 0)

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def ENDDAT(self):
            return self.getToken(KRLParser.ENDDAT, 0)

        def initialisation(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.InitialisationContext)
            else:
                return self.getTypedRuleContext(KRLParser.InitialisationContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_dataList




    def dataList(self):

        localctx = KRLParser.DataListContext(self, self._ctx, self.state)
        self.enterRule(localctx, 6, self.RULE_dataList)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 141
            self.match(KRLParser.DEFDAT)
            self.state = 142
            self.match(KRLParser.NAME)
            self.state = 143
            self.eol()
            self.state = 147
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==9:
                self.state = 144
                self.initialisation()
                self.state = 149
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 150
            self.match(KRLParser.ENDDAT)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class EolContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def NEWLINE(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.NEWLINE)
            else:
                return self.getToken(KRLParser.NEWLINE, i)

        def getRuleIndex(self):
            return KRLParser.RULE_eol




    def eol(self):

        localctx = KRLParser.EolContext(self, self._ctx, self.state)
        self.enterRule(localctx, 8, self.RULE_eol)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 153 
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while True:
                self.state = 152
                self.match(KRLParser.NEWLINE)
                self.state = 155 
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                if not (_la==76):
                    break

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class DeclarationContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def DECL(self):
            return self.getToken(KRLParser.DECL, 0)

        def type_(self):
            return self.getTypedRuleContext(KRLParser.TypeContext,0)


        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_declaration




    def declaration(self):

        localctx = KRLParser.DeclarationContext(self, self._ctx, self.state)
        self.enterRule(localctx, 10, self.RULE_declaration)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 157
            self.match(KRLParser.DECL)
            self.state = 158
            self.type_()
            self.state = 159
            self.match(KRLParser.NAME)
            self.state = 160
            self.eol()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class InitialisationContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def DECL(self):
            return self.getToken(KRLParser.DECL, 0)

        def type_(self):
            return self.getTypedRuleContext(KRLParser.TypeContext,0)


        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def ASSIGN(self):
            return self.getToken(KRLParser.ASSIGN, 0)

        def literal(self):
            return self.getTypedRuleContext(KRLParser.LiteralContext,0)


        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_initialisation




    def initialisation(self):

        localctx = KRLParser.InitialisationContext(self, self._ctx, self.state)
        self.enterRule(localctx, 12, self.RULE_initialisation)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 162
            self.match(KRLParser.DECL)
            self.state = 163
            self.type_()
            self.state = 164
            self.match(KRLParser.NAME)
            self.state = 165
            self.match(KRLParser.ASSIGN)
            self.state = 166
            self.literal()
            self.state = 167
            self.eol()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class TypeContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def INT(self):
            return self.getToken(KRLParser.INT, 0)

        def REAL(self):
            return self.getToken(KRLParser.REAL, 0)

        def BOOL(self):
            return self.getToken(KRLParser.BOOL, 0)

        def CHAR(self):
            return self.getToken(KRLParser.CHAR, 0)

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_type




    def type_(self):

        localctx = KRLParser.TypeContext(self, self._ctx, self.state)
        self.enterRule(localctx, 14, self.RULE_type)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 169
            _la = self._input.LA(1)
            if not((((_la) & ~0x3f) == 0 and ((1 << _la) & 68853694532) != 0) or _la==69):
                self._errHandler.recoverInline(self)
            else:
                self._errHandler.reportMatch(self)
                self.consume()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class StatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def simpleStatement(self):
            return self.getTypedRuleContext(KRLParser.SimpleStatementContext,0)


        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def ifStatement(self):
            return self.getTypedRuleContext(KRLParser.IfStatementContext,0)


        def forStatement(self):
            return self.getTypedRuleContext(KRLParser.ForStatementContext,0)


        def whileStatement(self):
            return self.getTypedRuleContext(KRLParser.WhileStatementContext,0)


        def repeatStatement(self):
            return self.getTypedRuleContext(KRLParser.RepeatStatementContext,0)


        def loopStatement(self):
            return self.getTypedRuleContext(KRLParser.LoopStatementContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_statement




    def statement(self):

        localctx = KRLParser.StatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 16, self.RULE_statement)
        try:
            self.state = 189
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [3, 7, 8, 22, 25, 28, 29, 35, 38, 39, 43, 46, 69]:
                self.enterOuterAlt(localctx, 1)
                self.state = 171
                self.simpleStatement()
                self.state = 172
                self.eol()
                pass
            elif token in [26]:
                self.enterOuterAlt(localctx, 2)
                self.state = 174
                self.ifStatement()
                self.state = 175
                self.eol()
                pass
            elif token in [24]:
                self.enterOuterAlt(localctx, 3)
                self.state = 177
                self.forStatement()
                self.state = 178
                self.eol()
                pass
            elif token in [48]:
                self.enterOuterAlt(localctx, 4)
                self.state = 180
                self.whileStatement()
                self.state = 181
                self.eol()
                pass
            elif token in [37]:
                self.enterOuterAlt(localctx, 5)
                self.state = 183
                self.repeatStatement()
                self.state = 184
                self.eol()
                pass
            elif token in [30]:
                self.enterOuterAlt(localctx, 6)
                self.state = 186
                self.loopStatement()
                self.state = 187
                self.eol()
                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class SimpleStatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def assignment(self):
            return self.getTypedRuleContext(KRLParser.AssignmentContext,0)


        def call(self):
            return self.getTypedRuleContext(KRLParser.CallContext,0)


        def motion(self):
            return self.getTypedRuleContext(KRLParser.MotionContext,0)


        def interrupt(self):
            return self.getTypedRuleContext(KRLParser.InterruptContext,0)


        def trigger(self):
            return self.getTypedRuleContext(KRLParser.TriggerContext,0)


        def wait(self):
            return self.getTypedRuleContext(KRLParser.WaitContext,0)


        def brake(self):
            return self.getTypedRuleContext(KRLParser.BrakeContext,0)


        def exit(self):
            return self.getTypedRuleContext(KRLParser.ExitContext,0)


        def halt(self):
            return self.getTypedRuleContext(KRLParser.HaltContext,0)


        def continue_(self):
            return self.getTypedRuleContext(KRLParser.ContinueContext,0)


        def resume(self):
            return self.getTypedRuleContext(KRLParser.ResumeContext,0)


        def return_(self):
            return self.getTypedRuleContext(KRLParser.ReturnContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_simpleStatement




    def simpleStatement(self):

        localctx = KRLParser.SimpleStatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 18, self.RULE_simpleStatement)
        try:
            self.state = 203
            self._errHandler.sync(self)
            la_ = self._interp.adaptivePredict(self._input,10,self._ctx)
            if la_ == 1:
                self.enterOuterAlt(localctx, 1)
                self.state = 191
                self.assignment()
                pass

            elif la_ == 2:
                self.enterOuterAlt(localctx, 2)
                self.state = 192
                self.call()
                pass

            elif la_ == 3:
                self.enterOuterAlt(localctx, 3)
                self.state = 193
                self.motion()
                pass

            elif la_ == 4:
                self.enterOuterAlt(localctx, 4)
                self.state = 194
                self.interrupt()
                pass

            elif la_ == 5:
                self.enterOuterAlt(localctx, 5)
                self.state = 195
                self.trigger()
                pass

            elif la_ == 6:
                self.enterOuterAlt(localctx, 6)
                self.state = 196
                self.wait()
                pass

            elif la_ == 7:
                self.enterOuterAlt(localctx, 7)
                self.state = 197
                self.brake()
                pass

            elif la_ == 8:
                self.enterOuterAlt(localctx, 8)
                self.state = 198
                self.exit()
                pass

            elif la_ == 9:
                self.enterOuterAlt(localctx, 9)
                self.state = 199
                self.halt()
                pass

            elif la_ == 10:
                self.enterOuterAlt(localctx, 10)
                self.state = 200
                self.continue_()
                pass

            elif la_ == 11:
                self.enterOuterAlt(localctx, 11)
                self.state = 201
                self.resume()
                pass

            elif la_ == 12:
                self.enterOuterAlt(localctx, 12)
                self.state = 202
                self.return_()
                pass


        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class AssignmentContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def variable(self):
            return self.getTypedRuleContext(KRLParser.VariableContext,0)


        def ASSIGN(self):
            return self.getToken(KRLParser.ASSIGN, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def aggregate(self):
            return self.getTypedRuleContext(KRLParser.AggregateContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_assignment




    def assignment(self):

        localctx = KRLParser.AssignmentContext(self, self._ctx, self.state)
        self.enterRule(localctx, 20, self.RULE_assignment)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 205
            self.variable()
            self.state = 206
            self.match(KRLParser.ASSIGN)
            self.state = 209
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [23, 31, 44, 57, 60, 69, 70, 71, 72, 73, 74]:
                self.state = 207
                self.expression()
                pass
            elif token in [64]:
                self.state = 208
                self.aggregate()
                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class CallContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def LPAREN(self):
            return self.getToken(KRLParser.LPAREN, 0)

        def RPAREN(self):
            return self.getToken(KRLParser.RPAREN, 0)

        def arguments(self):
            return self.getTypedRuleContext(KRLParser.ArgumentsContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_call




    def call(self):

        localctx = KRLParser.CallContext(self, self._ctx, self.state)
        self.enterRule(localctx, 22, self.RULE_call)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 211
            self.match(KRLParser.NAME)
            self.state = 212
            self.match(KRLParser.LPAREN)
            self.state = 214
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            if ((((_la - 23)) & ~0x3f) == 0 and ((1 << (_la - 23)) & 4433385504112897) != 0):
                self.state = 213
                self.arguments()


            self.state = 216
            self.match(KRLParser.RPAREN)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ArgumentsContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def expression(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.ExpressionContext)
            else:
                return self.getTypedRuleContext(KRLParser.ExpressionContext,i)


        def COMMA(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.COMMA)
            else:
                return self.getToken(KRLParser.COMMA, i)

        def getRuleIndex(self):
            return KRLParser.RULE_arguments




    def arguments(self):

        localctx = KRLParser.ArgumentsContext(self, self._ctx, self.state)
        self.enterRule(localctx, 24, self.RULE_arguments)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 218
            self.expression()
            self.state = 223
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==66:
                self.state = 219
                self.match(KRLParser.COMMA)
                self.state = 220
                self.expression()
                self.state = 225
                self._errHandler.sync(self)
                _la = self._input.LA(1)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class IfStatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def IF(self):
            return self.getToken(KRLParser.IF, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def THEN(self):
            return self.getToken(KRLParser.THEN, 0)

        def eol(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.EolContext)
            else:
                return self.getTypedRuleContext(KRLParser.EolContext,i)


        def ENDIF(self):
            return self.getToken(KRLParser.ENDIF, 0)

        def statement(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.StatementContext)
            else:
                return self.getTypedRuleContext(KRLParser.StatementContext,i)


        def ELSE(self):
            return self.getToken(KRLParser.ELSE, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_ifStatement




    def ifStatement(self):

        localctx = KRLParser.IfStatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 26, self.RULE_ifStatement)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 226
            self.match(KRLParser.IF)
            self.state = 227
            self.expression()
            self.state = 228
            self.match(KRLParser.THEN)
            self.state = 229
            self.eol()
            self.state = 233
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                self.state = 230
                self.statement()
                self.state = 235
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 244
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            if _la==15:
                self.state = 236
                self.match(KRLParser.ELSE)
                self.state = 237
                self.eol()
                self.state = 241
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                    self.state = 238
                    self.statement()
                    self.state = 243
                    self._errHandler.sync(self)
                    _la = self._input.LA(1)



            self.state = 246
            self.match(KRLParser.ENDIF)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ForStatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def FOR(self):
            return self.getToken(KRLParser.FOR, 0)

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def ASSIGN(self):
            return self.getToken(KRLParser.ASSIGN, 0)

        def expression(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.ExpressionContext)
            else:
                return self.getTypedRuleContext(KRLParser.ExpressionContext,i)


        def TO(self):
            return self.getToken(KRLParser.TO, 0)

        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def ENDFOR(self):
            return self.getToken(KRLParser.ENDFOR, 0)

        def statement(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.StatementContext)
            else:
                return self.getTypedRuleContext(KRLParser.StatementContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_forStatement




    def forStatement(self):

        localctx = KRLParser.ForStatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 28, self.RULE_forStatement)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 248
            self.match(KRLParser.FOR)
            self.state = 249
            self.match(KRLParser.NAME)
            self.state = 250
            self.match(KRLParser.ASSIGN)
            self.state = 251
            self.expression()
            self.state = 252
            self.match(KRLParser.TO)
            self.state = 253
            self.expression()
            self.state = 254
            self.eol()
            self.state = 258
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                self.state = 255
                self.statement()
                self.state = 260
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 261
            self.match(KRLParser.ENDFOR)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class WhileStatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def WHILE(self):
            return self.getToken(KRLParser.WHILE, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def ENDWHILE(self):
            return self.getToken(KRLParser.ENDWHILE, 0)

        def statement(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.StatementContext)
            else:
                return self.getTypedRuleContext(KRLParser.StatementContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_whileStatement




    def whileStatement(self):

        localctx = KRLParser.WhileStatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 30, self.RULE_whileStatement)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 263
            self.match(KRLParser.WHILE)
            self.state = 264
            self.expression()
            self.state = 265
            self.eol()
            self.state = 269
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                self.state = 266
                self.statement()
                self.state = 271
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 272
            self.match(KRLParser.ENDWHILE)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class RepeatStatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def REPEAT(self):
            return self.getToken(KRLParser.REPEAT, 0)

        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def UNTIL(self):
            return self.getToken(KRLParser.UNTIL, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def statement(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.StatementContext)
            else:
                return self.getTypedRuleContext(KRLParser.StatementContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_repeatStatement




    def repeatStatement(self):

        localctx = KRLParser.RepeatStatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 32, self.RULE_repeatStatement)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 274
            self.match(KRLParser.REPEAT)
            self.state = 275
            self.eol()
            self.state = 279
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                self.state = 276
                self.statement()
                self.state = 281
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 282
            self.match(KRLParser.UNTIL)
            self.state = 283
            self.expression()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class LoopStatementContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def LOOP(self):
            return self.getToken(KRLParser.LOOP, 0)

        def eol(self):
            return self.getTypedRuleContext(KRLParser.EolContext,0)


        def ENDLOOP(self):
            return self.getToken(KRLParser.ENDLOOP, 0)

        def statement(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.StatementContext)
            else:
                return self.getTypedRuleContext(KRLParser.StatementContext,i)


        def getRuleIndex(self):
            return KRLParser.RULE_loopStatement




    def loopStatement(self):

        localctx = KRLParser.LoopStatementContext(self, self._ctx, self.state)
        self.enterRule(localctx, 34, self.RULE_loopStatement)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 285
            self.match(KRLParser.LOOP)
            self.state = 286
            self.eol()
            self.state = 290
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while (((_la) & ~0x3f) == 0 and ((1 << _la) & 361638247006600) != 0) or _la==69:
                self.state = 287
                self.statement()
                self.state = 292
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 293
            self.match(KRLParser.ENDLOOP)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ExitContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def EXIT(self):
            return self.getToken(KRLParser.EXIT, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_exit




    def exit(self):

        localctx = KRLParser.ExitContext(self, self._ctx, self.state)
        self.enterRule(localctx, 36, self.RULE_exit)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 295
            self.match(KRLParser.EXIT)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class HaltContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def HALT(self):
            return self.getToken(KRLParser.HALT, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_halt




    def halt(self):

        localctx = KRLParser.HaltContext(self, self._ctx, self.state)
        self.enterRule(localctx, 38, self.RULE_halt)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 297
            self.match(KRLParser.HALT)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ContinueContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def CONTINUE(self):
            return self.getToken(KRLParser.CONTINUE, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_continue




    def continue_(self):

        localctx = KRLParser.ContinueContext(self, self._ctx, self.state)
        self.enterRule(localctx, 40, self.RULE_continue)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 299
            self.match(KRLParser.CONTINUE)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class WaitContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def WAIT(self):
            return self.getToken(KRLParser.WAIT, 0)

        def FOR(self):
            return self.getToken(KRLParser.FOR, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def SEC(self):
            return self.getToken(KRLParser.SEC, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_wait




    def wait(self):

        localctx = KRLParser.WaitContext(self, self._ctx, self.state)
        self.enterRule(localctx, 42, self.RULE_wait)
        try:
            self.state = 307
            self._errHandler.sync(self)
            la_ = self._interp.adaptivePredict(self._input,21,self._ctx)
            if la_ == 1:
                self.enterOuterAlt(localctx, 1)
                self.state = 301
                self.match(KRLParser.WAIT)
                self.state = 302
                self.match(KRLParser.FOR)
                self.state = 303
                self.expression()
                pass

            elif la_ == 2:
                self.enterOuterAlt(localctx, 2)
                self.state = 304
                self.match(KRLParser.WAIT)
                self.state = 305
                self.match(KRLParser.SEC)
                self.state = 306
                self.expression()
                pass


        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ReturnContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def RETURN(self):
            return self.getToken(KRLParser.RETURN, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_return




    def return_(self):

        localctx = KRLParser.ReturnContext(self, self._ctx, self.state)
        self.enterRule(localctx, 44, self.RULE_return)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 309
            self.match(KRLParser.RETURN)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class MotionContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def PTP(self):
            return self.getToken(KRLParser.PTP, 0)

        def target(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.TargetContext)
            else:
                return self.getTypedRuleContext(KRLParser.TargetContext,i)


        def C_PTP(self):
            return self.getToken(KRLParser.C_PTP, 0)

        def LIN(self):
            return self.getToken(KRLParser.LIN, 0)

        def C_DIS(self):
            return self.getToken(KRLParser.C_DIS, 0)

        def CIRC(self):
            return self.getToken(KRLParser.CIRC, 0)

        def COMMA(self):
            return self.getToken(KRLParser.COMMA, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_motion




    def motion(self):

        localctx = KRLParser.MotionContext(self, self._ctx, self.state)
        self.enterRule(localctx, 46, self.RULE_motion)
        self._la = 0 # Token type
        try:
            self.state = 328
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [35]:
                self.enterOuterAlt(localctx, 1)
                self.state = 311
                self.match(KRLParser.PTP)
                self.state = 312
                self.target()
                self.state = 314
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                if _la==5:
                    self.state = 313
                    self.match(KRLParser.C_PTP)


                pass
            elif token in [29]:
                self.enterOuterAlt(localctx, 2)
                self.state = 316
                self.match(KRLParser.LIN)
                self.state = 317
                self.target()
                self.state = 319
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                if _la==4:
                    self.state = 318
                    self.match(KRLParser.C_DIS)


                pass
            elif token in [7]:
                self.enterOuterAlt(localctx, 3)
                self.state = 321
                self.match(KRLParser.CIRC)
                self.state = 322
                self.target()
                self.state = 323
                self.match(KRLParser.COMMA)
                self.state = 324
                self.target()
                self.state = 326
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                if _la==4:
                    self.state = 325
                    self.match(KRLParser.C_DIS)


                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class TargetContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def variable(self):
            return self.getTypedRuleContext(KRLParser.VariableContext,0)


        def aggregate(self):
            return self.getTypedRuleContext(KRLParser.AggregateContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_target




    def target(self):

        localctx = KRLParser.TargetContext(self, self._ctx, self.state)
        self.enterRule(localctx, 48, self.RULE_target)
        try:
            self.state = 332
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [69]:
                self.enterOuterAlt(localctx, 1)
                self.state = 330
                self.variable()
                pass
            elif token in [64]:
                self.enterOuterAlt(localctx, 2)
                self.state = 331
                self.aggregate()
                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class InterruptContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def INTERRUPT(self):
            return self.getToken(KRLParser.INTERRUPT, 0)

        def DECL(self):
            return self.getToken(KRLParser.DECL, 0)

        def INTEGER(self):
            return self.getToken(KRLParser.INTEGER, 0)

        def WHEN(self):
            return self.getToken(KRLParser.WHEN, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def DO(self):
            return self.getToken(KRLParser.DO, 0)

        def interruptAction(self):
            return self.getTypedRuleContext(KRLParser.InterruptActionContext,0)


        def ON(self):
            return self.getToken(KRLParser.ON, 0)

        def OFF(self):
            return self.getToken(KRLParser.OFF, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_interrupt




    def interrupt(self):

        localctx = KRLParser.InterruptContext(self, self._ctx, self.state)
        self.enterRule(localctx, 50, self.RULE_interrupt)
        try:
            self.state = 348
            self._errHandler.sync(self)
            la_ = self._interp.adaptivePredict(self._input,27,self._ctx)
            if la_ == 1:
                self.enterOuterAlt(localctx, 1)
                self.state = 334
                self.match(KRLParser.INTERRUPT)
                self.state = 335
                self.match(KRLParser.DECL)
                self.state = 336
                self.match(KRLParser.INTEGER)
                self.state = 337
                self.match(KRLParser.WHEN)
                self.state = 338
                self.expression()
                self.state = 339
                self.match(KRLParser.DO)
                self.state = 340
                self.interruptAction()
                pass

            elif la_ == 2:
                self.enterOuterAlt(localctx, 2)
                self.state = 342
                self.match(KRLParser.INTERRUPT)
                self.state = 343
                self.match(KRLParser.ON)
                self.state = 344
                self.match(KRLParser.INTEGER)
                pass

            elif la_ == 3:
                self.enterOuterAlt(localctx, 3)
                self.state = 345
                self.match(KRLParser.INTERRUPT)
                self.state = 346
                self.match(KRLParser.OFF)
                self.state = 347
                self.match(KRLParser.INTEGER)
                pass


        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class InterruptActionContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def call(self):
            return self.getTypedRuleContext(KRLParser.CallContext,0)


        def brake(self):
            return self.getTypedRuleContext(KRLParser.BrakeContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_interruptAction




    def interruptAction(self):

        localctx = KRLParser.InterruptActionContext(self, self._ctx, self.state)
        self.enterRule(localctx, 52, self.RULE_interruptAction)
        try:
            self.state = 352
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [69]:
                self.enterOuterAlt(localctx, 1)
                self.state = 350
                self.call()
                pass
            elif token in [3]:
                self.enterOuterAlt(localctx, 2)
                self.state = 351
                self.brake()
                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class BrakeContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def BRAKE(self):
            return self.getToken(KRLParser.BRAKE, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_brake




    def brake(self):

        localctx = KRLParser.BrakeContext(self, self._ctx, self.state)
        self.enterRule(localctx, 54, self.RULE_brake)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 354
            self.match(KRLParser.BRAKE)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ResumeContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def RESUME(self):
            return self.getToken(KRLParser.RESUME, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_resume




    def resume(self):

        localctx = KRLParser.ResumeContext(self, self._ctx, self.state)
        self.enterRule(localctx, 56, self.RULE_resume)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 356
            self.match(KRLParser.RESUME)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class TriggerContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def TRIGGER(self):
            return self.getToken(KRLParser.TRIGGER, 0)

        def WHEN(self):
            return self.getToken(KRLParser.WHEN, 0)

        def DISTANCE(self):
            return self.getToken(KRLParser.DISTANCE, 0)

        def ASSIGN(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.ASSIGN)
            else:
                return self.getToken(KRLParser.ASSIGN, i)

        def INTEGER(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.INTEGER)
            else:
                return self.getToken(KRLParser.INTEGER, i)

        def DELAY(self):
            return self.getToken(KRLParser.DELAY, 0)

        def DO(self):
            return self.getToken(KRLParser.DO, 0)

        def triggerAction(self):
            return self.getTypedRuleContext(KRLParser.TriggerActionContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_trigger




    def trigger(self):

        localctx = KRLParser.TriggerContext(self, self._ctx, self.state)
        self.enterRule(localctx, 58, self.RULE_trigger)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 358
            self.match(KRLParser.TRIGGER)
            self.state = 359
            self.match(KRLParser.WHEN)
            self.state = 360
            self.match(KRLParser.DISTANCE)
            self.state = 361
            self.match(KRLParser.ASSIGN)
            self.state = 362
            self.match(KRLParser.INTEGER)
            self.state = 363
            self.match(KRLParser.DELAY)
            self.state = 364
            self.match(KRLParser.ASSIGN)
            self.state = 365
            self.match(KRLParser.INTEGER)
            self.state = 366
            self.match(KRLParser.DO)
            self.state = 367
            self.triggerAction()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class TriggerActionContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def assignment(self):
            return self.getTypedRuleContext(KRLParser.AssignmentContext,0)


        def call(self):
            return self.getTypedRuleContext(KRLParser.CallContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_triggerAction




    def triggerAction(self):

        localctx = KRLParser.TriggerActionContext(self, self._ctx, self.state)
        self.enterRule(localctx, 60, self.RULE_triggerAction)
        try:
            self.state = 371
            self._errHandler.sync(self)
            la_ = self._interp.adaptivePredict(self._input,29,self._ctx)
            if la_ == 1:
                self.enterOuterAlt(localctx, 1)
                self.state = 369
                self.assignment()
                pass

            elif la_ == 2:
                self.enterOuterAlt(localctx, 2)
                self.state = 370
                self.call()
                pass


        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ExpressionContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def disjunction(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.DisjunctionContext)
            else:
                return self.getTypedRuleContext(KRLParser.DisjunctionContext,i)


        def relation(self):
            return self.getTypedRuleContext(KRLParser.RelationContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_expression




    def expression(self):

        localctx = KRLParser.ExpressionContext(self, self._ctx, self.state)
        self.enterRule(localctx, 62, self.RULE_expression)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 373
            self.disjunction()
            self.state = 377
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            if (((_la) & ~0x3f) == 0 and ((1 << _la) & 35465847065542656) != 0):
                self.state = 374
                self.relation()
                self.state = 375
                self.disjunction()


        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class RelationContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def EQUALS(self):
            return self.getToken(KRLParser.EQUALS, 0)

        def NOT_EQUAL(self):
            return self.getToken(KRLParser.NOT_EQUAL, 0)

        def LESS(self):
            return self.getToken(KRLParser.LESS, 0)

        def GREATER(self):
            return self.getToken(KRLParser.GREATER, 0)

        def AT_MOST(self):
            return self.getToken(KRLParser.AT_MOST, 0)

        def AT_LEAST(self):
            return self.getToken(KRLParser.AT_LEAST, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_relation




    def relation(self):

        localctx = KRLParser.RelationContext(self, self._ctx, self.state)
        self.enterRule(localctx, 64, self.RULE_relation)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 379
            _la = self._input.LA(1)
            if not((((_la) & ~0x3f) == 0 and ((1 << _la) & 35465847065542656) != 0)):
                self._errHandler.recoverInline(self)
            else:
                self._errHandler.reportMatch(self)
                self.consume()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class DisjunctionContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def conjunction(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.ConjunctionContext)
            else:
                return self.getTypedRuleContext(KRLParser.ConjunctionContext,i)


        def OR(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.OR)
            else:
                return self.getToken(KRLParser.OR, i)

        def getRuleIndex(self):
            return KRLParser.RULE_disjunction




    def disjunction(self):

        localctx = KRLParser.DisjunctionContext(self, self._ctx, self.state)
        self.enterRule(localctx, 66, self.RULE_disjunction)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 381
            self.conjunction()
            self.state = 386
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==34:
                self.state = 382
                self.match(KRLParser.OR)
                self.state = 383
                self.conjunction()
                self.state = 388
                self._errHandler.sync(self)
                _la = self._input.LA(1)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ConjunctionContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def sum_(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.SumContext)
            else:
                return self.getTypedRuleContext(KRLParser.SumContext,i)


        def AND(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.AND)
            else:
                return self.getToken(KRLParser.AND, i)

        def getRuleIndex(self):
            return KRLParser.RULE_conjunction




    def conjunction(self):

        localctx = KRLParser.ConjunctionContext(self, self._ctx, self.state)
        self.enterRule(localctx, 68, self.RULE_conjunction)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 389
            self.sum_()
            self.state = 394
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==1:
                self.state = 390
                self.match(KRLParser.AND)
                self.state = 391
                self.sum_()
                self.state = 396
                self._errHandler.sync(self)
                _la = self._input.LA(1)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class SumContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def product(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.ProductContext)
            else:
                return self.getTypedRuleContext(KRLParser.ProductContext,i)


        def PLUS(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.PLUS)
            else:
                return self.getToken(KRLParser.PLUS, i)

        def MINUS(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.MINUS)
            else:
                return self.getToken(KRLParser.MINUS, i)

        def getRuleIndex(self):
            return KRLParser.RULE_sum




    def sum_(self):

        localctx = KRLParser.SumContext(self, self._ctx, self.state)
        self.enterRule(localctx, 70, self.RULE_sum)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 397
            self.product()
            self.state = 402
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==56 or _la==57:
                self.state = 398
                _la = self._input.LA(1)
                if not(_la==56 or _la==57):
                    self._errHandler.recoverInline(self)
                else:
                    self._errHandler.reportMatch(self)
                    self.consume()
                self.state = 399
                self.product()
                self.state = 404
                self._errHandler.sync(self)
                _la = self._input.LA(1)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ProductContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def factor(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.FactorContext)
            else:
                return self.getTypedRuleContext(KRLParser.FactorContext,i)


        def TIMES(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.TIMES)
            else:
                return self.getToken(KRLParser.TIMES, i)

        def DIVIDE(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.DIVIDE)
            else:
                return self.getToken(KRLParser.DIVIDE, i)

        def getRuleIndex(self):
            return KRLParser.RULE_product




    def product(self):

        localctx = KRLParser.ProductContext(self, self._ctx, self.state)
        self.enterRule(localctx, 72, self.RULE_product)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 405
            self.factor()
            self.state = 410
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==58 or _la==59:
                self.state = 406
                _la = self._input.LA(1)
                if not(_la==58 or _la==59):
                    self._errHandler.recoverInline(self)
                else:
                    self._errHandler.reportMatch(self)
                    self.consume()
                self.state = 407
                self.factor()
                self.state = 412
                self._errHandler.sync(self)
                _la = self._input.LA(1)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class FactorContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def NOT(self):
            return self.getToken(KRLParser.NOT, 0)

        def factor(self):
            return self.getTypedRuleContext(KRLParser.FactorContext,0)


        def primary(self):
            return self.getTypedRuleContext(KRLParser.PrimaryContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_factor




    def factor(self):

        localctx = KRLParser.FactorContext(self, self._ctx, self.state)
        self.enterRule(localctx, 74, self.RULE_factor)
        try:
            self.state = 416
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [31]:
                self.enterOuterAlt(localctx, 1)
                self.state = 413
                self.match(KRLParser.NOT)
                self.state = 414
                self.factor()
                pass
            elif token in [23, 44, 57, 60, 69, 70, 71, 72, 73, 74]:
                self.enterOuterAlt(localctx, 2)
                self.state = 415
                self.primary()
                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class PrimaryContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def literal(self):
            return self.getTypedRuleContext(KRLParser.LiteralContext,0)


        def variable(self):
            return self.getTypedRuleContext(KRLParser.VariableContext,0)


        def call(self):
            return self.getTypedRuleContext(KRLParser.CallContext,0)


        def LPAREN(self):
            return self.getToken(KRLParser.LPAREN, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def RPAREN(self):
            return self.getToken(KRLParser.RPAREN, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_primary




    def primary(self):

        localctx = KRLParser.PrimaryContext(self, self._ctx, self.state)
        self.enterRule(localctx, 76, self.RULE_primary)
        try:
            self.state = 425
            self._errHandler.sync(self)
            la_ = self._interp.adaptivePredict(self._input,36,self._ctx)
            if la_ == 1:
                self.enterOuterAlt(localctx, 1)
                self.state = 418
                self.literal()
                pass

            elif la_ == 2:
                self.enterOuterAlt(localctx, 2)
                self.state = 419
                self.variable()
                pass

            elif la_ == 3:
                self.enterOuterAlt(localctx, 3)
                self.state = 420
                self.call()
                pass

            elif la_ == 4:
                self.enterOuterAlt(localctx, 4)
                self.state = 421
                self.match(KRLParser.LPAREN)
                self.state = 422
                self.expression()
                self.state = 423
                self.match(KRLParser.RPAREN)
                pass


        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class VariableContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def NAME(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.NAME)
            else:
                return self.getToken(KRLParser.NAME, i)

        def index(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.IndexContext)
            else:
                return self.getTypedRuleContext(KRLParser.IndexContext,i)


        def DOT(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.DOT)
            else:
                return self.getToken(KRLParser.DOT, i)

        def getRuleIndex(self):
            return KRLParser.RULE_variable




    def variable(self):

        localctx = KRLParser.VariableContext(self, self._ctx, self.state)
        self.enterRule(localctx, 78, self.RULE_variable)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 427
            self.match(KRLParser.NAME)
            self.state = 429
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            if _la==62:
                self.state = 428
                self.index()


            self.state = 438
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==68:
                self.state = 431
                self.match(KRLParser.DOT)
                self.state = 432
                self.match(KRLParser.NAME)
                self.state = 434
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                if _la==62:
                    self.state = 433
                    self.index()


                self.state = 440
                self._errHandler.sync(self)
                _la = self._input.LA(1)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class IndexContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def LBRACKET(self):
            return self.getToken(KRLParser.LBRACKET, 0)

        def expression(self):
            return self.getTypedRuleContext(KRLParser.ExpressionContext,0)


        def RBRACKET(self):
            return self.getToken(KRLParser.RBRACKET, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_index




    def index(self):

        localctx = KRLParser.IndexContext(self, self._ctx, self.state)
        self.enterRule(localctx, 80, self.RULE_index)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 441
            self.match(KRLParser.LBRACKET)
            self.state = 442
            self.expression()
            self.state = 443
            self.match(KRLParser.RBRACKET)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class LiteralContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def INTEGER(self):
            return self.getToken(KRLParser.INTEGER, 0)

        def REAL_NUMBER(self):
            return self.getToken(KRLParser.REAL_NUMBER, 0)

        def MINUS(self):
            return self.getToken(KRLParser.MINUS, 0)

        def TRUE(self):
            return self.getToken(KRLParser.TRUE, 0)

        def FALSE(self):
            return self.getToken(KRLParser.FALSE, 0)

        def BIT_STRING(self):
            return self.getToken(KRLParser.BIT_STRING, 0)

        def STRING(self):
            return self.getToken(KRLParser.STRING, 0)

        def ENUM_CONSTANT(self):
            return self.getToken(KRLParser.ENUM_CONSTANT, 0)

        def getRuleIndex(self):
            return KRLParser.RULE_literal




    def literal(self):

        localctx = KRLParser.LiteralContext(self, self._ctx, self.state)
        self.enterRule(localctx, 82, self.RULE_literal)
        self._la = 0 # Token type
        try:
            self.state = 454
            self._errHandler.sync(self)
            token = self._input.LA(1)
            if token in [57, 71, 72]:
                self.enterOuterAlt(localctx, 1)
                self.state = 446
                self._errHandler.sync(self)
                _la = self._input.LA(1)
                if _la==57:
                    self.state = 445
                    self.match(KRLParser.MINUS)


                self.state = 448
                _la = self._input.LA(1)
                if not(_la==71 or _la==72):
                    self._errHandler.recoverInline(self)
                else:
                    self._errHandler.reportMatch(self)
                    self.consume()
                pass
            elif token in [44]:
                self.enterOuterAlt(localctx, 2)
                self.state = 449
                self.match(KRLParser.TRUE)
                pass
            elif token in [23]:
                self.enterOuterAlt(localctx, 3)
                self.state = 450
                self.match(KRLParser.FALSE)
                pass
            elif token in [73]:
                self.enterOuterAlt(localctx, 4)
                self.state = 451
                self.match(KRLParser.BIT_STRING)
                pass
            elif token in [74]:
                self.enterOuterAlt(localctx, 5)
                self.state = 452
                self.match(KRLParser.STRING)
                pass
            elif token in [70]:
                self.enterOuterAlt(localctx, 6)
                self.state = 453
                self.match(KRLParser.ENUM_CONSTANT)
                pass
            else:
                raise NoViableAltException(self)

        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class AggregateContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def LBRACE(self):
            return self.getToken(KRLParser.LBRACE, 0)

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def COLON(self):
            return self.getToken(KRLParser.COLON, 0)

        def component(self, i:int=None):
            if i is None:
                return self.getTypedRuleContexts(KRLParser.ComponentContext)
            else:
                return self.getTypedRuleContext(KRLParser.ComponentContext,i)


        def RBRACE(self):
            return self.getToken(KRLParser.RBRACE, 0)

        def COMMA(self, i:int=None):
            if i is None:
                return self.getTokens(KRLParser.COMMA)
            else:
                return self.getToken(KRLParser.COMMA, i)

        def getRuleIndex(self):
            return KRLParser.RULE_aggregate




    def aggregate(self):

        localctx = KRLParser.AggregateContext(self, self._ctx, self.state)
        self.enterRule(localctx, 84, self.RULE_aggregate)
        self._la = 0 # Token type
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 456
            self.match(KRLParser.LBRACE)
            self.state = 457
            self.match(KRLParser.NAME)
            self.state = 458
            self.match(KRLParser.COLON)
            self.state = 459
            self.component()
            self.state = 464
            self._errHandler.sync(self)
            _la = self._input.LA(1)
            while _la==66:
                self.state = 460
                self.match(KRLParser.COMMA)
                self.state = 461
                self.component()
                self.state = 466
                self._errHandler.sync(self)
                _la = self._input.LA(1)

            self.state = 467
            self.match(KRLParser.RBRACE)
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx


    class ComponentContext(ParserRuleContext):
        __slots__ = 'parser'

        def __init__(self, parser, parent:ParserRuleContext=None, invokingState:int=-1):
            super().__init__(parent, invokingState)
            self.parser = parser

        def NAME(self):
            return self.getToken(KRLParser.NAME, 0)

        def literal(self):
            return self.getTypedRuleContext(KRLParser.LiteralContext,0)


        def getRuleIndex(self):
            return KRLParser.RULE_component




    def component(self):

        localctx = KRLParser.ComponentContext(self, self._ctx, self.state)
        self.enterRule(localctx, 86, self.RULE_component)
        try:
            self.enterOuterAlt(localctx, 1)
            self.state = 469
            self.match(KRLParser.NAME)
            self.state = 470
            self.literal()
        except RecognitionException as re:
            localctx.exception = re
            self._errHandler.reportError(self, re)
            self._errHandler.recover(self, re)
        finally:
            self.exitRule()
        return localctx





