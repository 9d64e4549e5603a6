/* Made from interp/bytecode/instructions.tsv by python -m interp.bytecode.instruction_set --write. */
case KRL_LINE:
    krl_check_empty(flow);
    break;
case KRL_AT:
case KRL_JUMP:
case KRL_PROCEED:
case KRL_FAIL:
case KRL_UNLINKED:
case KRL_TELL_LOCAL:
case KRL_TELL_DATA:
case KRL_TELL_REF:
case KRL_TELL:
case KRL_TELL_BRANCH:
    break;
case KRL_JUMP_IF:
case KRL_JUMP_UNLESS:
    take(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_CASE:
    take_like(flow, operands[0]);
    push(flow, same(flow));
    break;
case KRL_CALL:
    take_arguments(flow, operands[0]);
    push_result(flow, operands[0]);
    break;
case KRL_RETURN:
    krl_check_no_result(flow);
    break;
case KRL_RETURN_VALUE:
    take_own_result(flow);
    break;
case KRL_ASK:
    take_request(flow, operands[0]);
    push_reply(flow, operands[0]);
    break;
case KRL_BUILTIN:
    take_inputs(flow, operands[0]);
    push_output(flow, operands[0]);
    break;
case KRL_PUSH_INT:
    push(flow, value(flow, KRL_TYPE_INT));
    break;
case KRL_PUSH_REAL:
    push(flow, value(flow, KRL_TYPE_REAL));
    break;
case KRL_PUSH_BOOL:
    push(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_PUSH_CHAR:
    push(flow, value(flow, KRL_TYPE_CHAR));
    break;
case KRL_PUSH_ENUM:
    krl_check_constant(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    push(flow, value(flow, operands[0]));
    break;
case KRL_PUSH_NOTHING:
    push(flow, nothing(flow));
    break;
case KRL_PUSH_NO_VIEW:
    krl_check_rank(flow, operands[1]);
    if (flow->is_wrong)
        return;
    push(flow, missing_view(flow, operands[0], operands[1]));
    break;
case KRL_DROP:
    take_any(flow);
    break;
case KRL_LOAD_LOCAL:
    push(flow, local(flow, operands[0]));
    break;
case KRL_LOAD_DATA:
    push(flow, data(flow, operands[0]));
    break;
case KRL_STORE_LOCAL:
    take(flow, local(flow, operands[0]));
    break;
case KRL_STORE_DATA:
    take(flow, data(flow, operands[0]));
    break;
case KRL_REF_LOCAL:
    krl_check_part_of_local(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    push(flow, reference(flow, operands[1]));
    break;
case KRL_REF_DATA:
    krl_check_part_of_data(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    push(flow, reference(flow, operands[1]));
    break;
case KRL_LOAD_REF:
    push(flow, parameter(flow, operands[0]));
    break;
case KRL_LOAD:
    take_reference_to_cell(flow);
    push(flow, same(flow));
    break;
case KRL_STORE:
    take_any(flow);
    take_reference_to_same(flow);
    break;
case KRL_MEMBER:
    take_whole(flow, operands[0], operands[1]);
    push(flow, reference(flow, operands[1]));
    break;
case KRL_INDEX:
    krl_check_array(flow, operands[0]);
    if (flow->is_wrong)
        return;
    take_indices(flow, operands[0]);
    take(flow, reference(flow, operands[0]));
    push(flow, element(flow, operands[0]));
    break;
case KRL_INDEX_LOCAL:
    krl_check_part_of_local(flow, operands[0], operands[1]);
    krl_check_array(flow, operands[1]);
    if (flow->is_wrong)
        return;
    take_indices(flow, operands[1]);
    push(flow, element(flow, operands[1]));
    break;
case KRL_INDEX_DATA:
    krl_check_part_of_data(flow, operands[0], operands[1]);
    krl_check_array(flow, operands[1]);
    if (flow->is_wrong)
        return;
    take_indices(flow, operands[1]);
    push(flow, element(flow, operands[1]));
    break;
case KRL_INDEX_VIEW:
    take_view_indices(flow, operands[0]);
    push(flow, view_element(flow, operands[0]));
    break;
case KRL_ELEMENT_LOCAL:
    krl_check_part_of_local(flow, operands[0], operands[1]);
    krl_check_array(flow, operands[1]);
    if (flow->is_wrong)
        return;
    take_indices(flow, operands[1]);
    push(flow, element_value(flow, operands[1]));
    break;
case KRL_ELEMENT_DATA:
    krl_check_part_of_data(flow, operands[0], operands[1]);
    krl_check_array(flow, operands[1]);
    if (flow->is_wrong)
        return;
    take_indices(flow, operands[1]);
    push(flow, element_value(flow, operands[1]));
    break;
case KRL_VIEW:
    krl_check_array(flow, operands[0]);
    if (flow->is_wrong)
        return;
    take(flow, reference(flow, operands[0]));
    push(flow, array_view(flow, operands[0]));
    break;
case KRL_LOAD_VIEW:
    push(flow, view_parameter(flow, operands[0]));
    break;
case KRL_PASS_VIEW:
    push(flow, missing_view_parameter(flow, operands[0]));
    break;
case KRL_ROW:
    krl_check_row(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    take_integers(flow, operands[1]);
    take(flow, reference(flow, operands[0]));
    push(flow, row(flow, operands[0], operands[1]));
    break;
case KRL_ROW_VIEW:
    krl_check_view_row(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    take_integers(flow, operands[1]);
    push(flow, view_row(flow, operands[0], operands[1]));
    break;
case KRL_COPY:
    take(flow, reference(flow, operands[0]));
    take(flow, reference(flow, operands[0]));
    break;
case KRL_CLEAR:
    take(flow, reference(flow, operands[0]));
    break;
case KRL_FILL_POSE:
    krl_check_positions(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    take(flow, reference(flow, operands[1]));
    take(flow, reference(flow, operands[0]));
    break;
case KRL_FILL_ARRAY:
    krl_check_rank(flow, operands[1]);
    if (flow->is_wrong)
        return;
    take(flow, view(flow, operands[0], operands[1]));
    take(flow, view(flow, operands[0], operands[1]));
    break;
case KRL_COPY_VIEW:
    krl_check_part_of_local(flow, operands[0], operands[1]);
    krl_check_array(flow, operands[1]);
    if (flow->is_wrong)
        return;
    take(flow, array_view(flow, operands[1]));
    push(flow, array_view(flow, operands[1]));
    break;
case KRL_SET_TEXT:
    take(flow, letters(flow));
    break;
case KRL_ADD_INT:
case KRL_SUB_INT:
case KRL_MUL_INT:
case KRL_DIV_INT:
case KRL_AND_BITS:
case KRL_OR_BITS:
case KRL_EXOR_BITS:
    take(flow, value(flow, KRL_TYPE_INT));
    take(flow, value(flow, KRL_TYPE_INT));
    push(flow, value(flow, KRL_TYPE_INT));
    break;
case KRL_NEG_INT:
case KRL_NOT_BITS:
case KRL_ADD_CONSTANT:
    take(flow, value(flow, KRL_TYPE_INT));
    push(flow, value(flow, KRL_TYPE_INT));
    break;
case KRL_ADD_REAL:
case KRL_SUB_REAL:
case KRL_MUL_REAL:
case KRL_DIV_REAL:
    take(flow, value(flow, KRL_TYPE_REAL));
    take(flow, value(flow, KRL_TYPE_REAL));
    push(flow, value(flow, KRL_TYPE_REAL));
    break;
case KRL_NEG_REAL:
    take(flow, value(flow, KRL_TYPE_REAL));
    push(flow, value(flow, KRL_TYPE_REAL));
    break;
case KRL_EQ_INT:
case KRL_NE_INT:
case KRL_LT_INT:
case KRL_GT_INT:
case KRL_LE_INT:
case KRL_GE_INT:
    take(flow, value(flow, KRL_TYPE_INT));
    take(flow, value(flow, KRL_TYPE_INT));
    push(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_EQ_REAL:
case KRL_NE_REAL:
case KRL_LT_REAL:
case KRL_GT_REAL:
case KRL_LE_REAL:
case KRL_GE_REAL:
    take(flow, value(flow, KRL_TYPE_REAL));
    take(flow, value(flow, KRL_TYPE_REAL));
    push(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_EQ_BOOL:
case KRL_NE_BOOL:
case KRL_AND_BOOL:
case KRL_OR_BOOL:
case KRL_EXOR_BOOL:
    take(flow, value(flow, KRL_TYPE_BOOL));
    take(flow, value(flow, KRL_TYPE_BOOL));
    push(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_EQ_ENUM:
case KRL_NE_ENUM:
    take_enumeration(flow);
    take(flow, same(flow));
    push(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_NOT_BOOL:
    take(flow, value(flow, KRL_TYPE_BOOL));
    push(flow, value(flow, KRL_TYPE_BOOL));
    break;
case KRL_COMPOSE:
    krl_check_poses(flow, operands[0], operands[1]);
    if (flow->is_wrong)
        return;
    take(flow, reference(flow, operands[1]));
    take(flow, reference(flow, operands[0]));
    take(flow, reference(flow, operands[1]));
    break;
case KRL_INT_TO_REAL:
    take(flow, value(flow, KRL_TYPE_INT));
    push(flow, value(flow, KRL_TYPE_REAL));
    break;
case KRL_REAL_TO_INT:
    take(flow, value(flow, KRL_TYPE_REAL));
    push(flow, value(flow, KRL_TYPE_INT));
    break;
case KRL_CHAR_TO_INT:
    take(flow, value(flow, KRL_TYPE_CHAR));
    push(flow, value(flow, KRL_TYPE_INT));
    break;
case KRL_INT_TO_CHAR:
    take(flow, value(flow, KRL_TYPE_INT));
    push(flow, value(flow, KRL_TYPE_CHAR));
    break;
case KRL_UNLESS_EQ_INT:
case KRL_UNLESS_NE_INT:
case KRL_UNLESS_LT_INT:
case KRL_UNLESS_GT_INT:
case KRL_UNLESS_LE_INT:
case KRL_UNLESS_GE_INT:
    take(flow, value(flow, KRL_TYPE_INT));
    take(flow, value(flow, KRL_TYPE_INT));
    break;
case KRL_UNLESS_LT_REAL:
case KRL_UNLESS_GT_REAL:
case KRL_UNLESS_LE_REAL:
case KRL_UNLESS_GE_REAL:
    take(flow, value(flow, KRL_TYPE_REAL));
    take(flow, value(flow, KRL_TYPE_REAL));
    break;
case KRL_FOR_LOCAL:
    krl_check_for_local(flow, operands[0], operands[1], operands[2]);
    break;
case KRL_FOR_DATA:
    krl_check_for_data(flow, operands[0], operands[1], operands[2]);
    break;
case KRL_PASS_LOCAL:
    push(flow, missing_local(flow, operands[0]));
    break;
