"""The values of KRL: operators, predefined functions, text formats, faults and poses."""
