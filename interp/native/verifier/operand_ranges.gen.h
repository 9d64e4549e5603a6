/* Made from interp/bytecode/instructions.tsv by python -m interp.bytecode.instruction_set --write. */
case KRL_OPERAND_BOOL: return operand >= 0 && operand < 2;
case KRL_OPERAND_CHAR: return operand >= 0 && operand < 256;
case KRL_OPERAND_COUNT: return operand >= 0;
case KRL_OPERAND_LOCAL: return operand >= 0 && operand < flow->code->frame;
case KRL_OPERAND_DATA: return operand >= 0 && operand < flow->program->data_cells;
case KRL_OPERAND_TYPE: return operand >= 0 && operand < flow->program->type_count;
case KRL_OPERAND_TEXT: return operand >= 0 && operand < flow->program->text_count;
case KRL_OPERAND_CODE: return operand >= 0 && operand < flow->program->code_count;
case KRL_OPERAND_ASK: return operand >= 0 && operand < flow->program->ask_count;
case KRL_OPERAND_BUILTIN: return operand >= 0 && operand < flow->program->builtin_count;
case KRL_OPERAND_FAULT: return operand >= 0 && operand < 13;
